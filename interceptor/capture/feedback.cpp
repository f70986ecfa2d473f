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

std::uint32_t word(const std::byte* at) {
  std::uint32_t value = 0;
  std::memcpy(&value, at, sizeof value);
  return value;
}

// `bytes` of each record: whole words.
void copyEach(std::byte* to, std::size_t to_stride, const std::byte* from, std::size_t from_stride,
              std::size_t bytes, std::uint64_t records) {
  constexpr std::size_t kFour = 16;
  for (std::uint64_t i = 0; i < records; ++i, to += to_stride, from += from_stride) {
    std::size_t at = 0;
    for (; at + kFour <= bytes; at += kFour) std::memcpy(to + at, from + at, kFour);
    for (; at < bytes; at += 4) std::memcpy(to + at, from + at, 4);
  }
}

std::uint64_t result(GLuint query) {
  GLuint primitives = 0;
  gl().GetQueryObjectuiv(query, GL_QUERY_RESULT, &primitives);
  return primitives;
}

}  // namespace

bool FeedbackLayout::empty() const {
  return capture_words == 0 &&
         std::all_of(outputs.begin(), outputs.end(), [](const auto& words) { return words.empty(); });
}

Feedback::~Feedback() {
  if (object_ != 0) gl().DeleteTransformFeedbacks(1, &object_);
  for (const Buffer& buffer : buffers_)
    if (buffer.name != 0) gl().DeleteBuffers(1, &buffer.name);
}

guard::Refusal Feedback::count(const FeedbackLayout& layout, const std::function<void()>& draw,
                               Records& records) {
  records.assign(layout.buffers(), 0);
  if (layout.empty()) return {};
  if (guard::Refusal refusal = reset(layout, Records(layout.buffers(), verticesOf(layout.mode)));
      !refusal.text.empty())
    return refusal;
  records = record(draw);
  return {};
}

guard::Refusal Feedback::reset(const FeedbackLayout& layout, Records records) {
  layout_ = layout;
  records_ = std::move(records);
  records_.resize(layout.buffers());
  if (layout.empty()) return {};
  if (facts_.pausesTransformFeedback()) {
    if (object_ == 0) gl().GenTransformFeedbacks(1, &object_);
    gl().BindTransformFeedback(GL_TRANSFORM_FEEDBACK, object_);
  }
  buffers_.resize(std::max(buffers_.size(), layout.buffers()));
  for (std::size_t i = 0; i < layout.buffers(); ++i)
    if (guard::Refusal refusal = makeRoom(i); !refusal.text.empty()) return refusal;
  return {};
}

guard::Refusal Feedback::makeRoom(std::size_t i) {
  if (layout_.words(i) == 0) return {};
  Buffer& buffer = buffers_[i];
  if (buffer.name == 0) gl().GenBuffers(1, &buffer.name);
  gl().BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, static_cast<GLuint>(i), buffer.name);
  const std::uint64_t wanted = std::max<std::uint64_t>(words(i), 4);
  if (wanted <= buffer.room && !layout_.holes) return {};
  const std::vector<std::uint32_t> zeros(layout_.holes ? wanted : 0);
  gl().BufferData(GL_TRANSFORM_FEEDBACK_BUFFER, static_cast<GLsizeiptr>(wanted * 4),
                  layout_.holes ? zeros.data() : nullptr, GL_STREAM_READ);
  buffer.room = wanted;
  if (!guard::clearErrors()) return {};
  buffer.room = 0;
  return guard::limit("the driver has no memory for " + std::to_string(wanted) +
                      " words of transform feedback; print fewer values at once");
}

Records Feedback::record(const std::function<void()>& draw) const {
  Records records(layout_.buffers(), 0);
  if (layout_.empty()) {
    draw();
    return records;
  }
  std::vector<GLuint> queries(records.size());
  gl().GenQueries(static_cast<GLsizei>(queries.size()), queries.data());
  gl().BeginQuery(GL_PRIMITIVES_GENERATED, queries[0]);
  for (GLuint i = 1; i < queries.size(); ++i) gl().BeginQueryIndexed(GL_PRIMITIVES_GENERATED, i, queries[i]);
  gl().BeginTransformFeedback(layout_.mode);
  draw();
  gl().EndTransformFeedback();
  gl().EndQuery(GL_PRIMITIVES_GENERATED);
  for (GLuint i = 1; i < queries.size(); ++i) gl().EndQueryIndexed(GL_PRIMITIVES_GENERATED, i);
  for (std::size_t i = 0; i < queries.size(); ++i)
    if (layout_.words(i) != 0) records[i] = result(queries[i]) * verticesOf(layout_.mode);
  gl().DeleteQueries(static_cast<GLsizei>(queries.size()), queries.data());
  return records;
}

void Feedback::leaveMode(GLenum mode) const {
  if (layout_.empty() || mode == layout_.mode) return;
  gl().BeginTransformFeedback(mode);
  gl().EndTransformFeedback();
}

std::uint64_t Feedback::words(std::size_t buffer) const {
  return buffer < records_.size() ? records_[buffer] * static_cast<std::uint64_t>(layout_.words(buffer)) : 0;
}

std::uint64_t Feedback::captureWords() const {
  return records_.empty() ? 0 : records_[0] * static_cast<std::uint64_t>(layout_.capture_words);
}

std::uint64_t Feedback::outputWords() const {
  std::uint64_t words = 0;
  for (std::size_t i = 0; i < records_.size(); ++i)
    words += records_[i] * static_cast<std::uint64_t>(layout_.outputWords(i));
  return words;
}

std::uint64_t Feedback::differing(const Records& some, const Records& others) const {
  std::uint64_t words = 0;
  for (std::size_t i = 0; i < std::min(some.size(), others.size()); ++i)
    words += (std::max(some[i], others[i]) - std::min(some[i], others[i])) *
             static_cast<std::uint64_t>(std::max(layout_.outputWords(i), 1));
  return words;
}

// False: there is something, but the driver does not map it.
template <class Use>
bool Feedback::mapped(std::size_t buffer, Use use) const {
  if (words(buffer) == 0) return true;
  gl().BindBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, buffers_[buffer].name);
  const void* memory = gl().MapBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0,
                                           static_cast<GLsizeiptr>(words(buffer) * 4), GL_MAP_READ_BIT);
  if (memory == nullptr) return false;
  use(static_cast<const std::byte*>(memory));
  gl().UnmapBuffer(GL_TRANSFORM_FEEDBACK_BUFFER);
  return true;
}

void Feedback::readRecords(std::byte* destination) const {
  mapped(0, [&](const std::byte* memory) { std::memcpy(destination, memory, words() * 4); });
}

void Feedback::readCaptures(std::byte* destination) const {
  const auto stride = static_cast<std::size_t>(layout_.words(0)) * 4;
  const auto bytes = static_cast<std::size_t>(layout_.capture_words) * 4;
  mapped(0,
         [&](const std::byte* memory) { copyEach(destination, bytes, memory, stride, bytes, records_[0]); });
}

void Feedback::readOutputs(std::byte* destination) const {
  for (std::size_t b = 0; b < records_.size(); ++b) {
    const auto stride = static_cast<std::size_t>(layout_.words(b)) * 4;
    const auto bytes = static_cast<std::size_t>(layout_.outputWords(b)) * 4;
    mapped(b, [&](const std::byte* memory) {
      copyEach(destination, bytes, memory + (stride - bytes), stride, bytes, records_[b]);
    });
    destination += records_[b] * bytes;
  }
}

// What cannot be looked at proves nothing: it counts as other.
guard::Difference Feedback::outputDifference(const std::byte* before) const {
  guard::Difference result;
  for (std::size_t b = 0; b < records_.size(); ++b) {
    const auto stride = static_cast<std::size_t>(layout_.words(b)) * 4;
    const auto bytes = static_cast<std::size_t>(layout_.outputWords(b)) * 4;
    const std::vector<guard::Number>& numbers = layout_.outputs[b];
    const bool seen = mapped(b, [&](const std::byte* memory) {
      if (stride == bytes) {
        result.add(guard::difference(numbers, before, memory, records_[b] * bytes, 4));
        return;
      }
      const std::byte* now = memory + (stride - bytes);
      for (std::uint64_t i = 0; i < records_[b]; ++i)
        for (std::size_t at = 0; at < bytes; at += 4) {
          const std::byte* expected = before + i * bytes + at;
          const std::byte* got = now + i * stride + at;
          if (word(expected) != word(got)) result.note(numbers[at / 4], expected, got);
        }
    });
    if (!seen) {
      result.components += records_[b] * bytes / 4;
      result.told = false;
    }
    before += records_[b] * bytes;
  }
  return result;
}

}  // namespace shadestep::capture
