// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/capture/feedback.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"

namespace shadestep::capture {
namespace {

using dispatch::gl;

std::uint64_t verticesOf(GLenum mode) {
  return mode == GL_TRIANGLES ? 3 : mode == GL_LINES ? 2 : 1;
}

}  // namespace

Feedback::~Feedback() {
  if (object_ != 0) gl().DeleteTransformFeedbacks(1, &object_);
  if (buffer_ != 0) gl().DeleteBuffers(1, &buffer_);
}

guard::Refusal Feedback::count(const FeedbackLayout& layout, const std::function<void()>& draw,
                               std::uint64_t& records) {
  records = 0;
  if (layout.words() == 0) return {};
  if (guard::Refusal refusal = reset(layout, verticesOf(layout.mode)); !refusal.text.empty()) return refusal;
  records = record(draw);
  return {};
}

guard::Refusal Feedback::reset(const FeedbackLayout& layout, std::uint64_t records) {
  layout_ = layout;
  records_ = records;
  if (layout.words() == 0) return {};
  if (facts_.pausesTransformFeedback()) {
    if (object_ == 0) gl().GenTransformFeedbacks(1, &object_);
    gl().BindTransformFeedback(GL_TRANSFORM_FEEDBACK, object_);
  }
  if (buffer_ == 0) gl().GenBuffers(1, &buffer_);
  gl().BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer_);
  const std::uint64_t wanted = std::max<std::uint64_t>(words(), 4);
  if (wanted <= room_ && !layout.holes) return {};
  const std::vector<std::uint32_t> zeros(layout.holes ? wanted : 0);
  gl().BufferData(GL_TRANSFORM_FEEDBACK_BUFFER, static_cast<GLsizeiptr>(wanted * 4),
                  layout.holes ? zeros.data() : nullptr, GL_STREAM_READ);
  room_ = wanted;
  if (!guard::clearErrors()) return {};
  room_ = 0;
  return guard::limit("the driver has no memory for " + std::to_string(wanted) +
                      " words of transform feedback; print fewer values at once");
}

std::uint64_t Feedback::record(const std::function<void()>& draw) const {
  if (layout_.words() == 0) {
    draw();
    return 0;
  }
  GLuint query = 0;
  gl().GenQueries(1, &query);
  gl().BeginQuery(GL_PRIMITIVES_GENERATED, query);
  gl().BeginTransformFeedback(layout_.mode);
  draw();
  gl().EndTransformFeedback();
  gl().EndQuery(GL_PRIMITIVES_GENERATED);
  GLuint primitives = 0;
  gl().GetQueryObjectuiv(query, GL_QUERY_RESULT, &primitives);
  gl().DeleteQueries(1, &query);
  return primitives * verticesOf(layout_.mode);
}

void Feedback::leaveMode(GLenum mode) const {
  if (layout_.words() == 0 || mode == layout_.mode) return;
  gl().BeginTransformFeedback(mode);
  gl().EndTransformFeedback();
}

template <class Use>
void Feedback::mapped(Use use) const {
  if (words() == 0) return;
  gl().BindBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, buffer_);
  const void* memory = gl().MapBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0,
                                           static_cast<GLsizeiptr>(words() * 4), GL_MAP_READ_BIT);
  if (memory == nullptr) return;
  use(static_cast<const std::byte*>(memory));
  gl().UnmapBuffer(GL_TRANSFORM_FEEDBACK_BUFFER);
}

void Feedback::read(void* destination) const {
  mapped([&](const std::byte* memory) { std::memcpy(destination, memory, words() * 4); });
}

void Feedback::readOutputs(std::byte* destination) const {
  const auto stride = static_cast<std::size_t>(layout_.words()) * 4;
  const auto bytes = static_cast<std::size_t>(layout_.output_words) * 4;
  mapped([&](const std::byte* memory) {
    for (std::uint64_t i = 0; i < records_; ++i)
      std::memcpy(destination + i * bytes, memory + i * stride + (stride - bytes), bytes);
  });
}

}  // namespace shadestep::capture
