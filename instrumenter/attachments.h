// Captured words on their way out: buffered in globals while the shader runs, written by the new main at its
// end (thesis 7.1.4: outputs may be read by the shader, so they are written last). Of fragments they leave
// through colour attachments, of a vertex shader through outputs for transform feedback, of all other stages
// through a storage block. Where the driver has none, those of evaluation and geometry shaders leave through
// transform feedback, too: the latter emit one point per thread instead of their own vertices.
//
//   uvec4 sd_words0;  out uvec4 sd_capture0;          (or vec4 and gl_FragData[first_frag_data])
//   ... sd_words0 = uvec4(3u, floatBitsToUint(a.x), floatBitsToUint(a.y), 0u) ...
//   sd_capture0 = sd_words0;
//
// In shaders that take derivatives, as a texture's level of detail, words of numbers are made of more than
// these: (sd_zero == 0u ? floatBitsToUint(a.x) : 0u), a uniform that is never set, hence 0, which no compiler
// knows. llvmpipe keeps what is made and captured on one side of a branch in the register of the captured
// word itself, which threads of the other side do not write: a derivative of it there would be made of what
// lay in theirs before.
//
// Fragments that end in a discard leave nothing there: they append their words to a list in a storage block,
// where the driver has those (AttachmentLayout::discarded_block).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "instrumenter/draft.h"

namespace shadestep::instrumenter {

class Attachments {
 public:
  // Chooses the carrier by dialect, outputs of the shader and target. Check `failure` before anything else.
  Attachments(Draft& draft, const Target& target);
  const std::string& failure() const { return failure_; }

  // Makes room for a value; false if `place` does not hold it.
  bool add(const std::string& name, const frontend::Type& type);
  // Has the words of floats made of more than constants: floatBitsToUint(a.x) ^ sd_zero. Mesa takes a choice
  // between the words of the constants -1.0 and 0.0, as the probes of a window make, for one between these
  // floats, and makes 0.0 of it by negating 0.0: -0.0. To be called before `declare`. (Single probes do
  // without: nothing would be left of what a shader leaves undefined, which is 0 elsewhere.)
  void hideConstants() { hides_constants_ = !floats(); }
  // What values have to fit into, for the user: "the draw buffers that the program leaves free".
  std::string place() const;
  // Ends the fields of one probe and hands out their layout; what is added next goes over the same words.
  AttachmentLayout overlay();
  // Declares what the layouts so far need. To be called once, after the last `add`.
  void declare();

  // GLSL expressions (comma-separated assignments). `values`: one expression per added field, in order.
  std::string assign(std::uint32_t mark, const std::vector<std::string>& values) const {
    return assign(layout_.fields, mark, values);
  }
  std::string assign(const std::vector<Field>& fields, std::uint32_t mark,
                     const std::vector<std::string>& values) const;
  // `nothing`: what stands for words that no value is captured in, a float or uint expression.
  std::string clear(std::uint32_t mark, const std::string& nothing = "") const;
  // The frame of a thread that captures, around the shader's own main: complete GLSL statements for its start
  // and for each of its ends, where the words are then handed over. To be called once, before the functions
  // along a call path are cloned.
  void frame(const std::string& start, const std::string& end);
  // That of a thread that does these statements, once, instead of the shader's own (a control shader's:
  // before them).
  void frameInstead(const std::string& statements);
  // That of a fragment that appends its words to the list of those that end in a discard: all do so, before
  // anything else, once these statements have set them. False where there are no storage blocks.
  bool frameListed(const std::string& statements);
  // GLSL statements that write the buffered words to the outputs.
  std::string write() const;

  bool feedback() const {
    return layout_.carrier == Carrier::uint_feedback || layout_.carrier == Carrier::float_feedback;
  }
  // With overlays: the words of the widest, and the fields of none.
  const AttachmentLayout& layout() const { return layout_; }

 private:
  std::string handOver();
  void chooseAttachments(const Target&);
  void chooseFeedbackOrList(const Target&);
  bool floats() const {
    return layout_.carrier == Carrier::float_attachments || layout_.carrier == Carrier::float_feedback;
  }
  std::vector<std::string> markAndIdentity(std::uint32_t mark) const;
  std::vector<std::string> valueWords(const std::string& value, const frontend::Type&) const;
  std::string assignWords(const std::vector<std::string>& words, int attachments,
                          const std::string& nothing = "") const;
  bool namesZero() const { return hides_constants_ || draft_.shader().traits.uses_derivatives; }
  std::string mixed(const std::string& word, frontend::Basic) const;
  std::string unrounded(const std::string& words) const;
  std::string markWord(std::uint32_t mark) const;
  std::string outputQualifiers(int index) const;
  void declareList(const std::string& block, int vectors);
  void declareDiscarded();
  std::string appendToDiscarded() const;
  std::string appendToList(const std::string& before) const;
  std::string buffer(int index) const { return draft_.name("words" + std::to_string(index)); }

  Draft& draft_;
  std::string failure_;
  AttachmentLayout layout_;
  bool frag_data_ = false;
  bool storage_ = false;  // can a storage block be declared?
  int capacity_ = 0;      // words
  bool hides_constants_ = false;
  std::vector<std::string> identity_;  // GLSL expressions
  int widest_ = 1;                     // of the overlays so far
  int first_word_ = 1;                 // behind the mark and the identity
  int list_vectors_ = 0;               // of a thread in the list
  int used_draw_buffers_ = 1;
};

}  // namespace shadestep::instrumenter
