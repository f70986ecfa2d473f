// Transform feedback of the agent's own: what the last stage before rasterization leaves, record by record,
// in the order in which the driver gives it (OpenGL 4.6, 13.3). Method: Strengert 2010, 7.1.3. Runs inside
// the program under debug: throws nothing, starts no thread, calls GL only through dispatch::gl().
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "interceptor/guard/context_facts.h"
#include "interceptor/guard/guards.h"
#include "interceptor/guard/refusal.h"
#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::capture {

// What a linked program gives to transform feedback.
struct FeedbackLayout {
  GLenum mode = GL_POINTS;  // or GL_LINES, GL_TRIANGLES
  int capture_words = 0;    // of a record: captures first
  int output_words = 0;     // then original outputs
  bool holes = false;       // there are words among them that nothing is written to
  int words() const { return capture_words + output_words; }
};

class Feedback {
 public:
  explicit Feedback(const guard::ContextFacts& facts) : facts_(facts) {}
  ~Feedback();
  Feedback(const Feedback&) = delete;
  Feedback& operator=(const Feedback&) = delete;

  // How many records `draw` makes. The program that makes them is current; the caller holds a FeedbackGuard
  // for this and all below.
  guard::Refusal count(const FeedbackLayout&, const std::function<void()>& draw, std::uint64_t& records);

  // Makes room for so many records.
  guard::Refusal reset(const FeedbackLayout&, std::uint64_t records);
  // Runs `draw` with the feedback on; the result is how many records it made, which may be more than there is
  // room for. (Mesa's software renderer counts nothing without the feedback.)
  std::uint64_t record(const std::function<void()>& draw) const;
  // Mesa 22.3 has one primitive mode for all feedback objects, the one that began last: the program's own
  // feedback, if it is paused, would refuse its draws. To be called last, with a program of this layout
  // current.
  void leaveMode(GLenum) const;

  std::uint64_t records() const { return records_; }
  int outputWords() const { return layout_.output_words; }
  std::uint64_t words() const { return records_ * static_cast<std::uint64_t>(layout_.words()); }
  // Whole records; only their original outputs. An error is left to the caller.
  void read(void* words) const;
  void readOutputs(std::byte* words) const;

 private:
  template <class Use>
  void mapped(Use) const;

  const guard::ContextFacts& facts_;
  GLuint object_ = 0, buffer_ = 0;
  std::uint64_t room_ = 0;  // words
  FeedbackLayout layout_;
  std::uint64_t records_ = 0;
};

}  // namespace shadestep::capture
