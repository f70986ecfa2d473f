// Transform feedback of the agent's own: what the last stage before rasterization leaves, record by record,
// in the order in which the driver gives it (OpenGL 4.6, 13.3). Method: Strengert 2010, 7.1.3. Runs inside
// the program under debug: throws nothing, starts no thread, calls GL only through dispatch::gl().
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "interceptor/guard/context_facts.h"
#include "interceptor/guard/guards.h"
#include "interceptor/guard/refusal.h"
#include "interceptor/guard/section.h"
#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::capture {

// What a linked program gives to transform feedback. A geometry shader's stream n goes to buffer n; only the
// first has captures.
struct FeedbackLayout {
  GLenum mode = GL_POINTS;  // or GL_LINES, GL_TRIANGLES
  int capture_words = 0;    // of a record of the first buffer: captures first
  std::vector<std::vector<guard::Number>> outputs =
      std::vector<std::vector<guard::Number>>(1);  // of each buffer: what the words of a record are ...
  bool holes = false;  // ... and whether there are some that nothing is written to
  std::size_t buffers() const { return outputs.size(); }
  int outputWords(std::size_t buffer) const { return static_cast<int>(outputs[buffer].size()); }
  int words(std::size_t buffer) const { return (buffer == 0 ? capture_words : 0) + outputWords(buffer); }
  bool empty() const;
};

// How many records each buffer gets.
using Records = std::vector<std::uint64_t>;

class Feedback {
 public:
  explicit Feedback(const guard::ContextFacts& facts) : facts_(facts) {}
  ~Feedback();
  Feedback(const Feedback&) = delete;
  Feedback& operator=(const Feedback&) = delete;

  // How many records `draw` makes. The program that makes them is current; the caller holds a FeedbackGuard
  // for this and all below.
  guard::Refusal count(const FeedbackLayout&, const std::function<void()>& draw, Records&);

  // Makes room for so many records.
  guard::Refusal reset(const FeedbackLayout&, Records);
  // Runs `draw` with the feedback on; the result is how many records it made, which may be more than there is
  // room for. (Mesa's software renderer counts nothing without the feedback.)
  Records record(const std::function<void()>& draw) const;
  // Mesa 22.3 has one primitive mode for all feedback objects, the one that began last: the program's own
  // feedback, if it is paused, would refuse its draws. To be called last, with a program of this layout
  // current.
  void leaveMode(GLenum) const;

  // Of the first buffer's records: all, and those of captures.
  std::uint64_t words() const { return words(0); }
  std::uint64_t captureWords() const;
  // Of all buffers, one behind the other.
  std::uint64_t outputWords() const;
  // The words of outputs in which two draws differ by their numbers of records alone.
  std::uint64_t differing(const Records&, const Records&) const;
  // Of the first buffer's records the captures, or all; the original outputs of all buffers. An error is left
  // to the caller.
  void readCaptures(std::byte* words) const;
  void readRecords(std::byte* words) const;
  void readOutputs(std::byte* words) const;
  // What of the outputs is other than it was when they were read before.
  guard::Difference outputDifference(const std::byte* before) const;

 private:
  struct Buffer {
    GLuint name = 0;
    std::uint64_t room = 0;  // words
  };
  guard::Refusal makeRoom(std::size_t buffer);
  std::uint64_t words(std::size_t buffer) const;
  template <class Use>
  bool mapped(std::size_t buffer, Use) const;

  const guard::ContextFacts& facts_;
  GLuint object_ = 0;
  std::vector<Buffer> buffers_;
  FeedbackLayout layout_;
  Records records_;
};

}  // namespace shadestep::capture
