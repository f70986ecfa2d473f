#include "instrumenter/accesses.h"

#include <algorithm>
#include <array>

#include "instrumenter/constructs/main.h"
#include "instrumenter/helpers/helpers.h"
#include "instrumenter/read_samplers.h"
#include "instrumenter/storage.h"

namespace shadestep::instrumenter {

using frontend::Shader;
using frontend::TokenRange;

namespace {

std::string written(const Shader& shader, TokenRange range) {
  std::string text;
  for (frontend::TokenIndex i = range.first; i <= range.last; ++i)
    text += (text.empty() ? "" : " ") + shader.tokens[static_cast<std::size_t>(i)].text;
  return text;
}

bool has(const std::string& name, const char* part) {
  return name.find(part) != std::string::npos;
}

// What a lookup's name and number of arguments say. Arguments by their index; 0 = there is none.
struct Form {
  std::string left_out;
  bool projective = false, fetch = false, gather = false;
  std::size_t lod = 0, bias = 0, gradient = 0, offset = 0;  // gradient: the first of two
  // The last argument that decides what is read.
  std::size_t last() const { return lod != 0 ? lod : bias != 0 ? bias : gradient != 0 ? gradient + 1 : 1; }
};

// Numbers only: it means the same behind the user's text.
bool isLiteral(const Shader& shader, TokenRange range) {
  for (frontend::TokenIndex i = range.first; i <= range.last; ++i) {
    const frontend::Token& token = shader.tokens[static_cast<std::size_t>(i)];
    if (token.kind == frontend::TokenKind::identifier && token.text != "int" && token.text != "ivec2" &&
        token.text != "ivec3")
      return false;
  }
  return true;
}

Form formOf(const Shader& shader, const TextureFetch& fetch, const SamplerKind& kind) {
  const std::string& name = fetch.function;
  const std::size_t count = fetch.arguments.size();
  Form form;
  form.projective = has(name, "Proj");
  form.fetch = has(name, "Fetch");
  form.gather = has(name, "Gather");
  const bool offset = has(name, "Offset");
  if (has(name, "Clamp") || has(name, "Offsets")) {
    form.left_out = "lookups by " + name + " are not counted";
  } else if (form.fetch) {
    const bool level = !kind.rectangle && !kind.buffer && !kind.multisample;
    if (level && count > 2) form.lod = 2;
    if (offset) form.offset = level ? 3 : 2;
  } else if (form.gather) {
    if (offset) form.offset = kind.shadow ? 3 : 2;
  } else if (has(name, "Lod")) {
    form.lod = 2;
    if (offset) form.offset = 3;
  } else if (has(name, "Grad")) {
    form.gradient = 2;
    if (offset) form.offset = 4;
    if (kind.cube) form.left_out = "which level " + name + " reads of a cube map is not known";
  } else {
    if (offset) form.offset = 2;
    const std::size_t bias = offset ? 3 : 2;
    const bool compares = kind.shadow && kind.cube && kind.array;
    if (count > bias && !compares) form.bias = bias;
  }
  const std::size_t needed = std::max({form.last(), form.offset, std::size_t{1}});
  if (count <= needed)
    form.left_out = "the call of " + name + " has too few arguments to be understood";
  else if (form.offset != 0 && !isLiteral(shader, fetch.arguments[form.offset]))
    form.left_out = "the offset of " + name + " is no literal";
  return form;
}

// How the lookups of one shader are counted.
class Accesses {
 public:
  Accesses(Draft& draft, const Target& target) : draft_(draft), target_(target), samplers_(draft) {}

  Result<AccessShader> count() {
    const Shader& shader = draft_.shader();
    fetches_ = textureFetches(shader);
    bool any = false;
    for (const TextureFetch& fetch : fetches_) {
      meanings_.push_back(samplers_.meaningOf(fetch.arguments.front(), functionOf(fetch)));
      Form form;
      if (meanings_.back().reason.empty()) form = formOf(shader, fetch, meanings_.back().kind);
      result_.left_out.push_back(meanings_.back().reason.empty() ? form.left_out : meanings_.back().reason);
      any = any || result_.left_out.back().empty();
      forms_.push_back(form);
    }
    if (fetches_.empty()) return Failure{"The shader looks up no texture."};
    if (!any) return Failure{"No lookup can be counted: " + result_.left_out.front() + "."};

    requireStorage(draft_);
    draft_.declare(inStorage(draft_, draft_.adapt(helpers::k_accesses_declarations)));
    defineFinite();
    draft_.append(draft_.adapt(helpers::k_accesses));
    result_.samplers = samplers_.samplers();
    draft_.declare(draft_.highp() + "int " + draft_.name("element(") + draft_.highp() + "int first, " +
                   draft_.highp() + "int index, " + draft_.highp() + "int count);");
    wraps_ = samplers_.declare(result_.slotWord(0));
    for (std::size_t i = 0; i < fetches_.size(); ++i)
      if (result_.left_out[i].empty()) countLookup(i);
    applyWraps();
    begin();
    auto text = draft_.finish();
    if (auto* failure = std::get_if<Failure>(&text)) return *failure;
    result_.text = std::move(std::get<std::string>(text));
    result_.block = draft_.name("Accesses");
    return std::move(result_);
  }

 private:
  // By its bits: drivers take a comparison for one of numbers.
  void defineFinite() {
    const Shader& shader = draft_.shader();
    const bool has_bits = draft_.es() ? shader.version >= 300 : shader.version >= 330;
    const bool asks = shader.version >= 130 && (has_bits || target_.bit_encoding);
    if (asks && !has_bits) draft_.require("GL_ARB_shader_bit_encoding");
    draft_.append("bool " + draft_.name("finite(float x) { return ") +
                  (asks ? "(floatBitsToInt(x) & 0x7f800000) != 0x7f800000; }" : "abs(x) < 1.0e18; }"));
  }

  // The function that the lookup stands in.
  const frontend::Function& functionOf(const TextureFetch& fetch) const {
    const Shader& shader = draft_.shader();
    for (const frontend::Function& function : shader.functions) {
      if (function.body == frontend::kNone) continue;
      const TokenRange body = shader.statements[static_cast<std::size_t>(function.body)].tokens;
      if (fetch.name >= body.first && fetch.name <= body.last) return function;
    }
    return shader.functions.front();  // lookups stand in functions only
  }

  void begin() {
    if (draft_.shader().stage == frontend::Stage::fragment) {
      draft_.append(draft_.adapt(helpers::k_accesses_fragment));
    } else {
      draft_.append("void " + draft_.name("begin() { ") + draft_.name("on = true; atomicAdd(") +
                    draft_.name("words[4], 1); }"));
    }
    draft_.declare("void " + draft_.name("begin();"));
    wrapMain(draft_, "  " + draft_.name("begin();\n"), "");
  }

  // Of two texts before the same token the one of the longer range is the outer one.
  void applyWraps() {
    std::stable_sort(wraps_.begin(), wraps_.end(), [](const auto& a, const auto& b) {
      return std::pair(a.range.first, -a.range.last) < std::pair(b.range.first, -b.range.last);
    });
    for (const ReadSamplers::Wrap& wrap : wraps_) draft_.edits.wrap(wrap.range, wrap.open, wrap.close);
  }

  std::string own(const std::string& what, std::size_t lookup) const {
    return draft_.name(what + std::to_string(lookup));
  }

  // A function of our own: declared before all of the user's text, defined behind it.
  void define(const std::string& header, const std::string& body) {
    draft_.declare(header + ";");
    draft_.append(header + " {\n" + body + "}");
  }

  // texture(s, P, bias) -> texture(s, sd_keep7(P), sd_here7(s, slot, bias)): the coordinates are kept, and
  // the last argument that decides counts.
  void countLookup(std::size_t lookup) {
    const TextureFetch& fetch = fetches_[lookup];
    const Form& form = forms_[lookup];
    const ReadSamplers::Meaning& meaning = meanings_[lookup];
    const std::string word = samplers_.word(meaning, result_.slotWord(0));
    const std::string here =
        own("here", lookup) + "(" + written(draft_.shader(), fetch.arguments.front()) + ", " + word + ", ";
    const bool counts_at_once = form.last() == 1;
    wraps_.push_back({fetch.arguments[1], (counts_at_once ? here : "") + own("keep", lookup) + "(",
                      counts_at_once ? "))" : ")"});
    if (form.gradient != 0)
      wraps_.push_back({fetch.arguments[form.gradient], own("keepx", lookup) + "(", ")"});
    if (!counts_at_once) wraps_.push_back({fetch.arguments[form.last()], here, ")"});
    if (form.fetch)
      defineFetch(lookup);
    else
      defineFiltered(lookup);
  }

  std::string vec(int components) const {
    return draft_.highp() + (components == 1 ? "float" : "vec" + std::to_string(components));
  }
  std::string ivec(int components) const {
    return draft_.highp() + (components == 1 ? "int" : "ivec" + std::to_string(components));
  }
  std::string offsetOf(std::size_t lookup) const {
    const Form& form = forms_[lookup];
    if (form.offset == 0) return "";
    return "(" + written(draft_.shader(), fetches_[lookup].arguments[form.offset]) + ")";
  }

  // "sampler2D s, int slot": what every counting function is given first.
  std::string given(std::size_t lookup) const {
    return draft_.highp() + meanings_[lookup].opaque_name + " s, " + draft_.highp() + "int slot, ";
  }

  // Defines `here`, which counts and hands through what it is given last. `type`: of that.
  void defineHere(std::size_t lookup, const std::string& type, const std::string& statements) {
    define(type + " " + own("here", lookup) + "(" + given(lookup) + type + " last)",
           statements + "  return last;\n");
  }

  void defineFetch(std::size_t lookup) {
    const SamplerKind& kind = meanings_[lookup].kind;
    const Form& form = forms_[lookup];
    const int coordinates = kind.coordinates();
    const std::string at = own("at", lookup);
    const std::string offset = offsetOf(lookup);
    draft_.declare(draft_.highp() + "ivec3 " + at + ";");
    const std::string moved = offset.empty()     ? "at"
                              : !kind.array      ? "(at + " + offset + ")"
                              : coordinates == 2 ? "(at + ivec2(" + offset + ", 0))"
                                                 : "(at + ivec3(" + offset + ", 0))";
    const std::string kept = coordinates == 1   ? "ivec3(" + moved + ", 0, 0)"
                             : coordinates == 3 ? moved
                             : kind.array       ? "ivec3(" + moved + ".x, 0, " + moved + ".y)"
                                                : "ivec3(" + moved + ", 0)";
    define(ivec(coordinates) + " " + own("keep", lookup) + "(" + ivec(coordinates) + " at)",
           "  " + at + " = " + kept + ";\n  return at;\n");
    const std::string site = std::to_string(result_.siteWord(lookup));
    defineHere(lookup, form.last() == 1 ? ivec(coordinates) : ivec(1),
               "  " + draft_.name("fetched(") + site + ", slot, " + at + ", " +
                   (form.lod != 0 ? "last" : "0") + ");\n");
  }

  // Coordinates as vec4: along up to three axes, then the layer.
  std::string spread(const SamplerKind& kind, const std::string& at) const {
    if (kind.cube) return kind.array ? at : "vec4(" + at + ", 0.0)";
    switch (kind.axes) {
      case 1:
        return kind.array ? "vec4(" + at + ".x, 0.0, 0.0, " + at + ".y)" : "vec4(" + at + ", 0.0, 0.0, 0.0)";
      case 2:
        return kind.array ? "vec4(" + at + ".xy, 0.0, " + at + ".z)" : "vec4(" + at + ", 0.0, 0.0)";
      default:
        return "vec4(" + at + ", 0.0)";
    }
  }

  // Overloads for all types that the coordinates of the lookup may have.
  void defineKeep(std::size_t lookup) {
    const SamplerKind& kind = meanings_[lookup].kind;
    const Form& form = forms_[lookup];
    const std::string at = own("at", lookup);
    static constexpr const char* kFirst[] = {"", ".x", ".xy", ".xyz", ""};
    const int coordinates = kind.coordinates();
    std::vector<int> types;
    if (form.projective) {
      types = {4};
      if (kind.axes < 3 && !kind.shadow) types.push_back(kind.axes + 1);
    } else {
      const bool compares = kind.shadow && !form.gather && coordinates < 4;
      types = {std::max(coordinates + (compares ? 1 : 0), compares ? 3 : 1)};
    }
    for (const int type : types) {
      const std::string first = type == coordinates ? "at" : std::string("at") + kFirst[coordinates];
      const std::string divided = form.projective ? "(" + first + " / at." + "xyzw"[type - 1] + ")" : first;
      define(vec(type) + " " + own("keep", lookup) + "(" + vec(type) + " at)",
             "  " + at + " = " + spread(kind, divided) + ";\n  return at;\n");
      if (form.last() == 1) defineHere(lookup, vec(type), countFiltered(lookup, ""));
    }
  }

  void defineFiltered(std::size_t lookup) {
    const SamplerKind& kind = meanings_[lookup].kind;
    const Form& form = forms_[lookup];
    draft_.declare(draft_.highp() + "vec4 " + own("at", lookup) + ";");
    defineKeep(lookup);
    if (form.gradient != 0) {
      draft_.declare(draft_.highp() + "vec3 " + own("dx", lookup) + ";");
      define(vec(kind.axes) + " " + own("keepx", lookup) + "(" + vec(kind.axes) + " dx)",
             "  " + own("dx", lookup) + " = " + three(kind.axes, "dx") + ";\n  return dx;\n");
    }
    if (form.last() != 1)
      defineHere(lookup, vec(form.gradient != 0 ? kind.axes : 1), countFiltered(lookup, "last"));
  }

  static std::string three(int axes, const std::string& value) {
    return axes == 3 ? value : "vec3(" + value + (axes == 2 ? ", 0.0)" : ", 0.0, 0.0)");
  }

  // The level of detail. Where derivatives decide it is asked for by every thread, whether it counts or not.
  std::string detail(std::size_t lookup, const std::string& last) {
    const Shader& shader = draft_.shader();
    const SamplerKind& kind = meanings_[lookup].kind;
    const Form& form = forms_[lookup];
    const std::string at = own("at", lookup);
    const std::string normalized = kind.rectangle ? "false" : "true";
    if (form.gather || kind.rectangle) return "0.0";
    if (form.lod != 0) return last + " + " + draft_.name("bias(slot)");
    if (form.gradient != 0)
      return draft_.name("detail(slot, ") + own("dx", lookup) + ", " + three(kind.axes, last) + ", " +
             normalized + ") + " + draft_.name("bias(slot)");
    if (shader.stage != frontend::Stage::fragment) return draft_.name("bias(slot)");
    const std::string bias = form.bias != 0 ? " + " + last : "";
    static constexpr const char* kAlong[] = {"", ".x", ".xy", ".xyz"};
    const bool asks = !draft_.es() && (shader.version >= 400 || (target_.query_lod && shader.version >= 130));
    if (asks) {
      if (shader.version < 400) draft_.require("GL_ARB_texture_query_lod");
      return std::string(shader.version >= 400 ? "textureQueryLod" : "textureQueryLOD") + "(s, " + at +
             kAlong[kind.cube ? 3 : kind.axes] + ").y" + bias;
    }
    result_.estimated = true;
    // Of a direction the derivatives count as those of the place on its face, which is about half as long.
    const std::string place = kind.cube ? "(0.5 * " + at + ".xyz / max(max(abs(" + at + ".x), abs(" + at +
                                              ".y)), abs(" + at + ".z)))"
                                        : at + ".xyz";
    return draft_.name("detail(slot, dFdx(") + place + "), dFdy(" + place + "), true) + " +
           draft_.name("bias(slot)") + bias;
  }

  // Statements that count the lookup; `last`: its last deciding argument, "" where that is the coordinates.
  std::string countFiltered(std::size_t lookup, const std::string& last) {
    const SamplerKind& kind = meanings_[lookup].kind;
    const std::string site = std::to_string(result_.siteWord(lookup));
    const std::string at = own("at", lookup);
    const std::string footprint = forms_[lookup].gather ? "true" : "false";
    std::string text = "  float lod = " + detail(lookup, last) + ";\n  ";
    if (kind.cube) {
      text += draft_.name("cube(") + site + ", slot, " + at + ", " + footprint + ", lod);\n";
    } else {
      const std::string offset = offsetOf(lookup);
      const std::string moved = offset.empty()   ? "vec3(0.0)"
                                : kind.axes == 3 ? "vec3(" + offset + ")"
                                                 : "vec3(" + vecNoPrecision(kind.axes) + "(" + offset + ")" +
                                                       (kind.axes == 2 ? ", 0.0)" : ", 0.0, 0.0)");
      text += draft_.name("filtered(") + site + ", slot, " + at + ", " + moved + ", " +
              std::to_string(kind.axes) + ", " + (kind.rectangle ? "false" : "true") + ", " + footprint +
              ", lod);\n";
    }
    return text;
  }
  static std::string vecNoPrecision(int components) {
    return components == 1 ? "float" : "vec" + std::to_string(components);
  }

  Draft& draft_;
  const Target& target_;
  ReadSamplers samplers_;
  std::vector<TextureFetch> fetches_;
  std::vector<ReadSamplers::Meaning> meanings_;
  std::vector<Form> forms_;
  std::vector<ReadSamplers::Wrap> wraps_;
  AccessShader result_;
};

}  // namespace

Result<AccessShader> instrumentAccesses(const Shader& shader, const Target& target) {
  if (shader.main == frontend::kNone)
    return Failure{"The shader has no main; it is a part of a program whose main is in another shader."};
  if (const std::string lacks = noStorage(shader, target); !lacks.empty())
    return Failure{"Where textures are read is counted in " + lacks + "."};
  Draft draft(shader);
  return Accesses(draft, target).count();
}

}  // namespace shadestep::instrumenter
