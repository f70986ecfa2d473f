#include "instrumenter/attachments.h"

#include <algorithm>

#include "instrumenter/constructs/discard.h"
#include "instrumenter/constructs/fragment_outputs.h"
#include "instrumenter/constructs/main.h"
#include "instrumenter/helpers/helpers.h"
#include "instrumenter/storage.h"
#include "instrumenter/words.h"

namespace shadestep::instrumenter {

using frontend::Type;

Attachments::Attachments(Draft& draft, const Target& target) : draft_(draft) {
  const frontend::Shader& shader = draft.shader();
  used_draw_buffers_ = target.used_draw_buffers;
  capacity_ = 4 * (target.max_draw_buffers - target.used_draw_buffers);
  if (shader.stage != frontend::Stage::fragment) {
    failure_ = "Only fragment shaders can be captured; choose --stage fragment.";
  } else if (shader.main == frontend::kNone) {
    failure_ = "The shader has no main; it is a part of a program whose main is in another shader.";
  } else if (draft.es() && shader.version < 300 && !target.es_draw_buffers) {
    failure_ =
        "A GLSL ES 1.00 shader has a single colour output on this driver, which lacks GL_EXT_draw_buffers, "
        "so "
        "nothing can be captured beside it.";
  } else if (capacity_ <= 0) {
    failure_ = "The program uses all " + std::to_string(target.max_draw_buffers) +
               " draw buffers of this driver (GL_MAX_DRAW_BUFFERS), so none is left to capture values in.";
  }

  if (draft.es() && shader.version < 300) draft.require("GL_EXT_draw_buffers");

  // gl_FragColor and gl_FragData exclude declared outputs, which below 1.30 only extensions bring.
  frag_data_ = writesFragData(shader) || (shader.version < 130 && shader.outputs.empty());
  const bool bits = shader.version >= 130 && (draft.es() || shader.version >= 330 || target.bit_encoding);
  layout_.carrier = !frag_data_ && bits ? Carrier::uint_attachments : Carrier::float_attachments;
  if (frag_data_) layout_.first_frag_data = target.used_draw_buffers;
  storage_ = noStorage(shader, target).empty();
}

bool Attachments::add(const std::string& name, const Type& type) {
  const bool floats = layout_.carrier == Carrier::float_attachments;
  const int words = floats ? channelCount(type) : frontend::wordCount(type);
  if (words == 0 || layout_.words + words > capacity_) return false;
  layout_.fields.push_back(Field{name, type, layout_.words});
  layout_.words += words;
  return true;
}

AttachmentLayout Attachments::overlay() {
  AttachmentLayout one = layout_;
  widest_ = std::max(widest_, layout_.words);
  layout_.fields.clear();
  layout_.words = 1;
  return one;
}

void Attachments::declare() {
  layout_.words = std::max(layout_.words, widest_);
  const bool floats = layout_.carrier == Carrier::float_attachments;
  const std::string type = draft_.highp() + (floats ? "vec4 " : "uvec4 ");
  if (!floats) prepareWords(draft_);
  if (floats && draft_.shader().version < 130) draft_.declare(draft_.adapt(helpers::k_attachment_halves));

  for (int i = 0; i < layout_.attachments(); ++i) {
    draft_.declare(type + buffer(i) + ";");
    if (frag_data_) continue;
    layout_.outputs.push_back(draft_.name("capture" + std::to_string(i)));
    // In ES a location can be given in the text only; below 1.30 the extension that brings outputs asks for
    // it.
    const bool located = draft_.es() || draft_.shader().version < 130;
    const std::string location =
        located ? "layout(location = " + std::to_string(used_draw_buffers_ + i) + ") " : "";
    draft_.declare(location + "out " + type + layout_.outputs.back() + ";");
  }
  if (frag_data_) replaceFragColor(draft_);
  if (draft_.es()) locateOnlyOutput(draft_);
}

std::string Attachments::assign(const std::vector<Field>& fields, std::uint32_t mark,
                                const std::vector<std::string>& values) const {
  std::vector<std::string> words = {markWord(mark)};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Type& type = fields[i].type;
    const std::vector<std::string> more = layout_.carrier == Carrier::float_attachments
                                              ? floatChannels(draft_, values[i], type)
                                              : uintWords(draft_, values[i], type);
    words.insert(words.end(), more.begin(), more.end());
  }
  return assignWords(words, (static_cast<int>(words.size()) + 3) / 4);
}

std::string Attachments::clear(std::uint32_t mark, const std::string& nothing) const {
  return assignWords({markWord(mark)}, layout_.attachments(), nothing);
}

void Attachments::frame(const std::string& start, const std::string& end) {
  wrapMain(draft_, start, end + write());
  if (!storage_ || !draft_.shader().traits.uses_discard) return;
  declareDiscarded();
  wrapDiscards(draft_, end + appendDiscarded());
}

void Attachments::declareDiscarded() {
  requireStorage(draft_);
  layout_.discarded_block = draft_.name("Discarded");
  layout_.discarded_words = 4 * (1 + layout_.attachments());
  const bool floats = layout_.carrier == Carrier::float_attachments;
  draft_.declare(inStorage(draft_, "layout(std430) buffer " + layout_.discarded_block + " { " +
                                       draft_.highp() + "int " + draft_.name("ended") + ", " +
                                       draft_.name("listed") + "; " + draft_.highp() +
                                       (floats ? "vec4 " : "uvec4 ") + draft_.name("discarded") + "[]; };"));
}

std::string Attachments::appendDiscarded() const {
  const bool floats = layout_.carrier == Carrier::float_attachments;
  const std::string order = draft_.name("order"), ended = draft_.name("ended");
  const std::string list =
      draft_.name("discarded[") + order + " * " + std::to_string(1 + layout_.attachments()) + " + ";
  std::string text = "  " + draft_.highp() + "int " + order + " = atomicAdd(" + ended + ", 1);\n  if (" +
                     order + " < " + draft_.name("listed") + ") {\n    " + list + "0] = ";
  text += floats ? "vec4(floor(gl_FragCoord.xy), gl_FragCoord.z, 1.0);\n"
                 : "uvec4(uvec2(gl_FragCoord.xy), floatBitsToUint(gl_FragCoord.z), 1u);\n";
  for (int i = 0; i < layout_.attachments(); ++i)
    text += "    " + list + std::to_string(i + 1) + "] = " + buffer(i) + ";\n";
  return text + "  }\n";
}

std::string Attachments::write() const {
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
  const bool floats = layout_.carrier == Carrier::float_attachments;
  const std::string zero = floats ? "0.0" : "0u";
  std::string text;
  for (int i = 0; i < attachments; ++i) {
    if (i > 0) text += ", ";
    text += buffer(i) + (floats ? " = vec4(" : " = uvec4(");
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
  return std::to_string(mark) + (layout_.carrier == Carrier::float_attachments ? ".0" : "u");
}

}  // namespace shadestep::instrumenter
