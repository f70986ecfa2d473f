#include "interceptor/agent/call_journal.h"

#include <atomic>
#include <cstring>
#include <mutex>
#include <span>
#include <utility>

namespace shadestep::agent {
namespace {

using Journal = wire::CallJournal;

constinit std::atomic<Journal*> journal{nullptr};

// `sending` is held by whoever sends a batch, and taken first; `filling` by whoever adds to one.
std::mutex sending, filling;
unsigned filled = 0;            // the batch that is filled
std::uint64_t last_number = 0;  // of the batches

flatbuffers::DetachedBuffer packed(const wire::CallT& call) {
  flatbuffers::FlatBufferBuilder builder(1024);
  builder.FinishSizePrefixed(wire::Call::Pack(builder, &call));
  return builder.Release();
}

bool add(Journal& to, std::span<const std::uint8_t> call) {
  const std::lock_guard lock(filling);
  Journal::Batch& batch = to.batches[filled];
  const std::uint64_t used = batch.used.load(std::memory_order_relaxed);
  // Sizes are multiples of 8, so that each call is aligned.
  const std::size_t padded = (call.size() + 7) / 8 * 8;
  if (padded > sizeof batch.bytes - used) return false;
  if (used == 0) batch.number.store(++last_number, std::memory_order_relaxed);
  std::memcpy(batch.bytes + used, call.data(), call.size());
  batch.used.store(used + padded, std::memory_order_release);
  return true;
}

}  // namespace

void useJournal(Journal* where) {
  journal.store(where);
}

Journal::Current* noteBegun(const wire::CallT& call) {
  Journal* const here = journal.load();
  if (here == nullptr) return nullptr;
  const flatbuffers::DetachedBuffer buffer = packed(call);
  for (Journal::Current& one : here->current) {
    if (buffer.size() > sizeof one.bytes) return nullptr;
    std::uint64_t free = 0;
    if (one.taken.load(std::memory_order_relaxed) != 0 || !one.taken.compare_exchange_strong(free, 1))
      continue;
    std::memcpy(one.bytes, buffer.data(), buffer.size());
    one.used.store(buffer.size(), std::memory_order_release);
    return &one;
  }
  return nullptr;
}

void noteReturned(Journal::Current* begun, const wire::CallT* call) {
  Journal* const here = journal.load();
  if (here == nullptr) return;
  if (begun != nullptr) {
    begun->used.store(0, std::memory_order_release);
    begun->taken.store(0, std::memory_order_release);
  }
  if (call == nullptr) return;
  const flatbuffers::DetachedBuffer buffer = packed(*call);
  if (buffer.size() > sizeof(Journal::Batch::bytes)) return;
  while (!add(*here, {buffer.data(), buffer.size()})) sendCalls();
}

void sendCalls(bool at_exit) {
  Journal* const here = journal.load();
  if (here == nullptr) return;
  std::unique_lock sends(sending, std::defer_lock);
  std::unique_lock fills(filling, std::defer_lock);
  if (at_exit) {
    if (!sends.try_lock() || !fills.try_lock()) return;
  } else {
    sends.lock();
    fills.lock();
  }
  Journal::Batch& batch = here->batches[filled];
  const std::uint64_t used = batch.used.load(std::memory_order_relaxed);
  if (used == 0) return;
  filled = 1 - filled;
  fills.unlock();

  wire::CallsT calls;
  calls.number = batch.number.load(std::memory_order_relaxed);
  const auto* first = reinterpret_cast<const std::uint8_t*>(batch.bytes);
  calls.batch.assign(first, first + used);
  sendToSession(std::move(calls), !at_exit);
  batch.used.store(0, std::memory_order_release);
}

}  // namespace shadestep::agent
