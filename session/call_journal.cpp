#include "session/call_journal.h"

#include <algorithm>
#include <memory>

namespace shadestep::session {
namespace {

CallBytes copied(const std::byte* bytes, std::uint64_t used, std::size_t room) {
  const auto* first = reinterpret_cast<const std::uint8_t*>(bytes);
  return {first, first + std::min<std::uint64_t>(used, room)};
}

}  // namespace

void readCalls(const CallBytes& bytes, bool returned,
               const std::function<void(const wire::CallT&, bool)>& visit) {
  std::size_t at = 0;
  while (bytes.size() - at > sizeof(flatbuffers::uoffset_t)) {
    const std::uint8_t* const first = bytes.data() + at;
    const std::size_t size = flatbuffers::GetPrefixedSize(first) + sizeof(flatbuffers::uoffset_t);
    if (size > bytes.size() - at) return;
    flatbuffers::Verifier verifier(first, size);
    if (!verifier.VerifySizePrefixedBuffer<wire::Call>(nullptr)) return;
    const std::unique_ptr<wire::CallT> call(flatbuffers::GetSizePrefixedRoot<wire::Call>(first)->UnPack());
    visit(*call, returned);
    at = std::min(bytes.size(), at + (size + 7) / 8 * 8);
  }
}

std::vector<CallBytes> unsentBatches(const wire::CallJournal& journal, std::uint64_t last) {
  std::vector<CallBytes> found;
  const wire::CallJournal::Batch* batches[] = {&journal.batches[0], &journal.batches[1]};
  if (batches[1]->number < batches[0]->number) std::swap(batches[0], batches[1]);
  for (const auto* batch : batches) {
    if (batch->number > last) found.push_back(copied(batch->bytes, batch->used, sizeof batch->bytes));
  }
  return found;
}

std::vector<CallBytes> currentCalls(const wire::CallJournal& journal) {
  std::vector<CallBytes> found;
  for (const auto& one : journal.current) {
    if (one.used > 0) found.push_back(copied(one.bytes, one.used, sizeof one.bytes));
  }
  return found;
}

}  // namespace shadestep::session
