// Captured words -> values, and a storage buffer -> the recorded threads.
#include <algorithm>
#include <bit>
#include <span>

#include "instrumenter/instrumenter.h"
#include "instrumenter/words.h"

namespace shadestep::instrumenter {

using frontend::Basic;
using frontend::Component;
using frontend::Type;

namespace {

bool isFloat(Carrier carrier) {
  return carrier == Carrier::float_attachments || carrier == Carrier::float_feedback;
}

// A channel that holds a small whole number as a float. What is none decodes to 0.
std::uint32_t wholeNumber(std::uint32_t float_bits) {
  const float value = std::bit_cast<float>(float_bits);
  return value >= 0.0F && value <= 65535.0F ? static_cast<std::uint32_t>(value + 0.5F) : 0;
}

int wordsOf(Basic basic) {
  Type scalar;
  scalar.basic = basic;
  return frontend::wordCount(scalar);
}

enum Mark : std::uint32_t { running = 0, finished = 1, discarded = 2 };

// One thread's part of the storage block: its header, then records.
class ThreadReader {
 public:
  ThreadReader(const RecordingLayout& layout, std::span<const std::uint32_t> words)
      : layout_(layout), words_(words) {}

  ThreadRecording read(std::uint32_t invocation, std::string& error) {
    ThreadRecording thread;
    thread.invocation = invocation;
    thread.wanted = words_[0];
    thread.x = static_cast<int>(words_[1]);
    thread.y = static_cast<int>(words_[2]);
    thread.discarded = words_[3] == discarded;
    thread.complete = words_[3] != running && thread.wanted <= words_.size();
    if (words_[3] > discarded) error = "the mark is " + std::to_string(words_[3]);
    if (words_[3] != running && thread.wanted < kThreadHeader) error = "it ended without having begun";
    if (error.empty()) readRecords(thread, error);
    return thread;
  }

 private:
  // A complete thread's records end exactly where it says; those of another end at the first that is missing.
  void readRecords(ThreadRecording& thread, std::string& error) {
    const std::size_t end = thread.complete ? thread.wanted : words_.size();
    for (std::size_t at = kThreadHeader; at < end;) {
      const std::uint32_t id = words_[at];
      if (id == 0 && !thread.complete) return;
      if (id == 0 || id > layout_.records.size()) {
        error =
            "record " + std::to_string(thread.records.size()) + " has the unknown id " + std::to_string(id);
        return;
      }
      const RecordLayout& record = layout_.records[id - 1];
      const std::size_t next = at + 1 + static_cast<std::size_t>(record.words);
      if (next > end) {
        error = "record " + std::to_string(thread.records.size()) + " is cut off";
        return;
      }
      thread.records.push_back(decodeRecord(static_cast<int>(id - 1), words_.subspan(at + 1)));
      at = next;
    }
  }

  Record decodeRecord(int layout, std::span<const std::uint32_t> words) const {
    Record record;
    record.layout = layout;
    for (const Field& field : layout_.records[static_cast<std::size_t>(layout)].fields) {
      const auto first = words.begin() + field.first_word;
      record.values.push_back({field.type, {first, first + frontend::wordCount(field.type)}});
    }
    return record;
  }

  const RecordingLayout& layout_;
  std::span<const std::uint32_t> words_;
};

Recording refused(const std::string& reason) {
  Recording recording;
  recording.error =
      "The recording cannot be read: " + reason + "; run it again, and report this if it happens again.";
  return recording;
}

}  // namespace

Value decode(const AttachmentLayout& layout, const Field& field, const std::uint32_t* words) {
  Value value{field.type, std::vector<std::uint32_t>(static_cast<std::size_t>(wordCount(field.type)))};
  FieldDecoder(layout, field).decode(words, value.words.data());
  return value;
}

FieldDecoder::FieldDecoder(const AttachmentLayout& layout, const Field& field)
    : first_(static_cast<std::size_t>(field.first_word)),
      words_(static_cast<std::size_t>(frontend::wordCount(field.type))),
      floats_(isFloat(layout.carrier)),
      components_(frontend::components(field.type)) {}

void FieldDecoder::decode(const std::uint32_t* thread, std::uint32_t* out) const {
  const std::uint32_t* channel = thread + first_;
  if (!floats_) {
    for (std::size_t i = 0; i < words_; ++i) out[i] = channel[i];
    return;
  }
  for (const Component& component : components_) {
    if (component.basic == Basic::float_) {
      *out++ = *channel++;
      continue;
    }
    for (int word = wordsOf(component.basic); word > 0; --word, channel += 2)
      *out++ = wholeNumber(channel[0]) | wholeNumber(channel[1]) << 16;
  }
}

namespace {

template <std::size_t kWords>
void copyWords(const std::uint32_t* from, std::size_t stride, std::size_t count, std::uint32_t* to) {
  for (std::size_t i = 0; i < count; ++i, from += stride, to += kWords)
    for (std::size_t w = 0; w < kWords; ++w) to[w] = from[w];
}

}  // namespace

void FieldDecoder::decode(const std::uint32_t* threads, std::size_t stride, std::size_t count,
                          std::uint32_t* out) const {
  if (!floats_) {
    const std::uint32_t* from = threads + first_;
    if (words_ == 1) return copyWords<1>(from, stride, count, out);
    if (words_ == 2) return copyWords<2>(from, stride, count, out);
    if (words_ == 3) return copyWords<3>(from, stride, count, out);
    if (words_ == 4) return copyWords<4>(from, stride, count, out);
  }
  for (std::size_t i = 0; i < count; ++i) decode(threads + i * stride, out + i * words_);
}

std::uint32_t decodeMark(const AttachmentLayout& layout, const std::uint32_t* words) {
  return isFloat(layout.carrier) ? wholeNumber(words[0]) : words[0];
}

std::uint32_t encodeMark(const AttachmentLayout& layout, std::uint32_t mark) {
  return isFloat(layout.carrier) ? std::bit_cast<std::uint32_t>(static_cast<float>(mark)) : mark;
}

DiscardedThreads decodeDiscarded(const AttachmentLayout& layout, std::span<const std::uint32_t> block) {
  DiscardedThreads result;
  if (block.size() < kDiscardedHeader || layout.discarded_words <= 4) return result;
  const auto words = static_cast<std::size_t>(layout.discarded_words);
  result.ended = block[0];
  const std::size_t count =
      std::min<std::size_t>(std::min(block[0], block[1]), (block.size() - kDiscardedHeader) / words);
  const bool floats = isFloat(layout.carrier);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t* at = block.data() + kDiscardedHeader + i * words;
    DiscardedThread thread;
    thread.x = static_cast<int>(floats ? wholeNumber(at[0]) : at[0]);
    thread.y = static_cast<int>(floats ? wholeNumber(at[1]) : at[1]);
    thread.depth = std::bit_cast<float>(at[2]);
    thread.words = at + 4;
    result.threads.push_back(thread);
  }
  return result;
}

Recording decodeRecording(const RecordingLayout& layout, std::span<const std::uint32_t> words) {
  if (words.size() < kRecordingHeader) return refused("there is no header");
  const std::size_t room = words[1];
  const std::size_t threads = std::min(words[0], words[2]);
  if (threads > 0 && room < kThreadHeader) return refused("there is no room for a thread");
  if (threads > 0 && threads > (words.size() - kRecordingHeader) / room)
    return refused("it is shorter than it says");

  Recording recording;
  recording.started = words[0];
  for (std::size_t i = 0; i < threads; ++i) {
    const auto part = words.subspan(kRecordingHeader + i * room, room);
    std::string error;
    recording.threads.push_back(ThreadReader(layout, part).read(static_cast<std::uint32_t>(i + 1), error));
    if (!error.empty()) return refused("in thread " + std::to_string(i) + ", " + error);
  }
  return recording;
}

}  // namespace shadestep::instrumenter
