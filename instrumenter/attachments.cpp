#include "instrumenter/attachments.h"

#include <algorithm>

#include "instrumenter/constructs/discard.h"
#include "instrumenter/constructs/fragment_outputs.h"
#include "instrumenter/constructs/geometry_output.h"
#include "instrumenter/constructs/main.h"
#include "instrumenter/helpers/helpers.h"
#include "instrumenter/storage.h"
#include "instrumenter/words.h"

namespace shadestep::instrumenter {

using frontend::Type;

namespace {

constexpr int kWidestListed = 1024;  // words of a thread in a list

Type typeOf(frontend::Basic basic) {
  Type type;
  type.basic = basic;
  return type;
}

bool hasBitEncoding(const frontend::Shader& shader, const Target& target) {
  return (isEs(shader) ? shader.version >= 300 : shader.version >= 330) || target.bit_encoding;
}

}  // namespace

Attachments::Attachments(Draft& draft, const Target& target) : draft_(draft) {
  const frontend::Shader& shader = draft.shader();
  storage_ = noStorage(shader, target).empty();
  if (shader.stage == frontend::Stage::fragment) {
    chooseAttachments(target);
  } else {
    chooseFeedbackOrList(target);
  }
  if (shader.main == frontend::kNone)
    failure_ = "The shader has no main; it is a part of a program whose main is in another shader.";
}

void Attachments::chooseAttachments(const Target& target) {
  const frontend::Shader& shader = draft_.shader();
  used_draw_buffers_ = target.used_draw_buffers;
  capacity_ = 4 * (target.max_draw_buffers - target.used_draw_buffers);
  if (draft_.es() && shader.version < 300 && !target.es_draw_buffers) {
    failure_ =
        "A GLSL ES 1.00 shader has a single colour output in this context, which lacks GL_EXT_draw_buffers, "
        "so "
        "nothing can be captured beside it; contexts of OpenGL ES have it (GStreamer: GST_GL_API=gles2 "
        "GST_GL_PLATFORM=egl).";
  } else if (capacity_ <= 0) {
    failure_ = "The program uses all " + std::to_string(target.max_draw_buffers) +
               " draw buffers of this driver (GL_MAX_DRAW_BUFFERS), so none is left to capture values in.";
  }

  if (draft_.es() && shader.version < 300) draft_.require("GL_EXT_draw_buffers");

  // gl_FragColor and gl_FragData exclude declared outputs, which below 1.30 only extensions bring.
  frag_data_ = writesFragData(shader) || (shader.version < 130 && shader.outputs.empty());
  const bool bits = shader.version >= 130 && hasBitEncoding(shader, target);
  layout_.carrier = !frag_data_ && bits ? Carrier::uint_attachments : Carrier::float_attachments;
  if (frag_data_) layout_.first_frag_data = target.used_draw_buffers;
}

void Attachments::chooseFeedbackOrList(const Target& target) {
  const frontend::Shader& shader = draft_.shader();
  const bool bits = hasBitEncoding(shader, target);
  const bool list = storage_ && bits;
  const bool prefers_feedback = shader.stage == frontend::Stage::vertex || !list;
  if (prefers_feedback && target.feedback_components > 0) {
    layout_.carrier = shader.version >= 130 && bits ? Carrier::uint_feedback : Carrier::float_feedback;
    capacity_ = target.feedback_components / 4 * 4;
  } else if (list) {
    layout_.carrier = Carrier::list;
    capacity_ = kWidestListed;
  } else {
    failure_ =
        "Values of this stage need " +
        (storage_ ? std::string("GL_ARB_shader_bit_encoding, which this driver lacks")
                  : noStorage(shader, target)) +
        (shader.stage == frontend::Stage::tess_control
             ? "; 'debug' shows what --stage vertex gives them and what --stage tess-eval makes of them."
             : ".");
  }
  for (const Identity& one : identityOf(shader, target)) {
    if (!one.extension.empty()) draft_.require(one.extension);
    if (add(one.name, typeOf(one.basic))) identity_.push_back(one.expression);
  }
  layout_.identity.swap(layout_.fields);
  first_word_ = layout_.words;
}

std::string Attachments::place() const {
  if (layout_.carrier == Carrier::list)
    return "the " + std::to_string(kWidestListed) + " words that are captured of a thread";
  if (feedback()) return "what transform feedback captures of a thread beside the outputs that are compared";
  return "the draw buffers that the program leaves free";
}

bool Attachments::add(const std::string& name, const Type& type) {
  const int words = floats() ? channelCount(type) : frontend::wordCount(type);
  if (words == 0 || layout_.words + words > capacity_) return false;
  layout_.fields.push_back(Field{name, type, layout_.words});
  layout_.words += words;
  return true;
}

AttachmentLayout Attachments::overlay() {
  AttachmentLayout one = layout_;
  widest_ = std::max(widest_, layout_.words);
  layout_.fields.clear();
  layout_.words = first_word_;
  return one;
}

void Attachments::declare() {
  layout_.words = std::max(layout_.words, widest_);
  const std::string type = draft_.highp() + (floats() ? "vec4 " : "uvec4 ");
  if (!floats()) prepareWords(draft_);
  if (namesZero())
    draft_.declare("uniform " + draft_.highp() + (floats() ? "float " : "uint ") + draft_.name("zero") + ";");
  if (floats() && draft_.shader().version < 130) draft_.declare(draft_.adapt(helpers::k_attachment_halves));

  for (int i = 0; i < layout_.attachments(); ++i) {
    draft_.declare(type + buffer(i) + ";");
    if (frag_data_ || layout_.carrier == Carrier::list) continue;
    layout_.outputs.push_back(draft_.name("capture" + std::to_string(i)));
    draft_.declare(outputQualifiers(i) + type + layout_.outputs.back() + ";");
  }
  if (layout_.carrier == Carrier::list) {
    layout_.list_block = draft_.name("List");
    declareList(layout_.list_block, layout_.attachments());
  }
  if (frag_data_) replaceFragColor(draft_);
  if (draft_.es() && draft_.shader().stage == frontend::Stage::fragment) locateOnlyOutput(draft_);
}

std::string Attachments::outputQualifiers(int index) const {
  const int version = draft_.shader().version;
  if (layout_.carrier == Carrier::uint_feedback) return "flat out ";
  if (layout_.carrier == Carrier::float_feedback) return version < 130 ? "varying " : "out ";
  // In ES a location can be given in the text only; below 1.30 the extension that brings outputs asks for it.
  const bool located = draft_.es() || version < 130;
  return located ? "layout(location = " + std::to_string(used_draw_buffers_ + index) + ") out " : "out ";
}

std::string Attachments::assign(const std::vector<Field>& fields, std::uint32_t mark,
                                const std::vector<std::string>& values) const {
  std::vector<std::string> words = markAndIdentity(mark);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::vector<std::string> more = valueWords(values[i], fields[i].type);
    words.insert(words.end(), more.begin(), more.end());
  }
  return assignWords(words, (static_cast<int>(words.size()) + 3) / 4);
}

std::string Attachments::clear(std::uint32_t mark, const std::string& nothing) const {
  return assignWords(markAndIdentity(mark), layout_.attachments(), nothing);
}

std::vector<std::string> Attachments::markAndIdentity(std::uint32_t mark) const {
  std::vector<std::string> words = {markWord(mark)};
  for (std::size_t i = 0; i < identity_.size(); ++i) {
    const std::vector<std::string> more = valueWords(identity_[i], layout_.identity[i].type);
    words.insert(words.end(), more.begin(), more.end());
  }
  return words;
}

std::vector<std::string> Attachments::valueWords(const std::string& value, const Type& type) const {
  std::vector<std::string> words =
      floats() ? floatChannels(draft_, value, type) : uintWords(draft_, value, type);
  if (!namesZero()) return words;
  std::size_t word = 0;
  for (const frontend::Component& component : frontend::components(type)) {
    const Type scalar = typeOf(component.basic);
    words[word] = mixed(words[word], component.basic);
    word += static_cast<std::size_t>(floats() ? channelCount(scalar) : frontend::wordCount(scalar));
  }
  return words;
}

// Only words that are the value's own: others are new ones as they are.
std::string Attachments::mixed(const std::string& word, frontend::Basic basic) const {
  const bool real = basic == frontend::Basic::float_;
  if (!real && (floats() || (basic != frontend::Basic::int_ && basic != frontend::Basic::uint_))) return word;
  const std::string zero = draft_.name("zero");
  const bool takes_derivatives = draft_.shader().traits.uses_derivatives;
  if (hides_constants_) return real || takes_derivatives ? word + " ^ " + zero : word;
  return "(" + zero + (floats() ? " == 0.0 ? " : " == 0u ? ") + word + (floats() ? " : 0.0)" : " : 0u)");
}

// A geometry shader that hands its words to transform feedback emits one point, and none of its own vertices.
std::string Attachments::handOver() {
  if (!feedback() || draft_.shader().stage != frontend::Stage::geometry) return write();
  declarePoints(draft_, 1);
  dropEmits(draft_);
  return write() + emitPoint();
}

void Attachments::frameInstead(const std::string& statements) {
  wrapMain(draft_, statements + handOver() + "  return;\n", "");
}

void Attachments::frame(const std::string& start, const std::string& end) {
  wrapMain(draft_, start, end + handOver());
  if (!storage_ || !draft_.shader().traits.uses_discard) return;
  declareDiscarded();
  wrapDiscards(draft_, end + appendToDiscarded());
}

bool Attachments::frameListed(const std::string& statements) {
  if (!storage_) return false;
  declareDiscarded();
  wrapMain(draft_, statements + appendToDiscarded(), handOver());
  return true;
}

void Attachments::declareDiscarded() {
  layout_.discarded_block = draft_.name("Discarded");
  layout_.discarded_words = 4 * (1 + layout_.attachments());
  declareList(layout_.discarded_block, 1 + layout_.attachments());
}

std::string Attachments::appendToDiscarded() const {
  return appendToList(floats() ? "vec4(floor(gl_FragCoord.xy), gl_FragCoord.z, 1.0)"
                               : "uvec4(uvec2(gl_FragCoord.xy), floatBitsToUint(gl_FragCoord.z), 1u)");
}

// A list of threads, to which appendToList appends.
void Attachments::declareList(const std::string& block, int vectors) {
  requireStorage(draft_);
  list_vectors_ = vectors;
  draft_.declare(inStorage(draft_, "layout(std430) buffer " + block + " { " + draft_.highp() + "int " +
                                       draft_.name("ended") + ", " + draft_.name("listed") + ", " +
                                       draft_.name("started") + "; " + draft_.highp() +
                                       (floats() ? "vec4 " : "uvec4 ") + draft_.name("list") + "[]; };"));
}

// `before`: a vector that comes before the buffered words, "" = none.
std::string Attachments::appendToList(const std::string& before) const {
  const std::string order = draft_.name("order"), ended = draft_.name("ended");
  const std::string list = draft_.name("list[") + order + " * " + std::to_string(list_vectors_) + " + ";
  std::string text = "  " + draft_.highp() + "int " + order + " = atomicAdd(" + ended + ", 1);\n  if (" +
                     order + " < " + draft_.name("listed") + ") {\n";
  int at = 0;
  if (!before.empty()) text += "    " + list + std::to_string(at++) + "] = " + before + ";\n";
  for (int i = 0; i < layout_.attachments(); ++i)
    text += "    " + list + std::to_string(at++) + "] = " + buffer(i) + ";\n";
  return text + "  }\n";
}

std::string Attachments::write() const {
  if (layout_.carrier == Carrier::list) return appendToList("");
  std::string text;
  for (int i = 0; i < layout_.attachments(); ++i) {
    const std::string output = frag_data_ ? "gl_FragData[" + std::to_string(layout_.first_frag_data + i) + "]"
                                          : layout_.outputs[static_cast<std::size_t>(i)];
    text += "  " + output + " = " + (frag_data_ ? unrounded(buffer(i)) : buffer(i)) + ";\n";
  }
  return frag_data_ ? text + broadcastFragColor(draft_.shader(), used_draw_buffers_) : text;
}

// gl_FragData is mediump in ES: Mesa rounds what is constant when it is assigned, and keeps all else as it
// is.
std::string Attachments::unrounded(const std::string& words) const {
  return draft_.es() ? "gl_FragCoord.x < -1.0 ? vec4(gl_FragCoord.x) : " + words : words;
}

std::string Attachments::assignWords(const std::vector<std::string>& words, int attachments,
                                     const std::string& nothing) const {
  const std::string zero = floats() ? "0.0" : "0u";
  std::string text;
  for (int i = 0; i < attachments; ++i) {
    if (i > 0) text += ", ";
    text += buffer(i) + (floats() ? " = vec4(" : " = uvec4(");
    for (std::size_t channel = 0; channel < 4; ++channel) {
      const std::size_t word = static_cast<std::size_t>(i) * 4 + channel;
      if (channel > 0) text += ", ";
      text += word < words.size() ? words[word] : nothing.empty() ? zero : nothing;
    }
    text += ")";
  }
  return text;
}

std::string Attachments::markWord(std::uint32_t mark) const {
  return std::to_string(mark) + (floats() ? ".0" : "u");
}

}  // namespace shadestep::instrumenter
