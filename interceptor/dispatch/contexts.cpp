// Runs inside the program under debug.
#include "interceptor/dispatch/contexts.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <vector>

#include "interceptor/calls/hooks.h"
#include "interceptor/dispatch/resolve.h"

namespace shadestep::dispatch {

namespace {

struct Record {
  Context context;
  unsigned threads = 0;  // that have it current
  bool destroyed = false;
};

struct Contexts {
  std::mutex mutex;
  std::vector<std::unique_ptr<Record>> records;
  std::uint64_t share_groups = 0;
};

// Never destroyed: threads may call GL while the program ends.
Contexts& contexts() {
  static Contexts* const all = new Contexts;
  return *all;
}

// This thread's contexts; a thread can hold one of each provider, and calls go to the one made current last.
constinit thread_local Record* bound[4] = {};
constinit thread_local Record* active = nullptr;

Record* find(Contexts& all, Provider provider, void* handle) {
  const auto found = std::ranges::find_if(all.records, [&](const auto& record) {
    return record->context.provider == provider && record->context.handle == handle && !record->destroyed;
  });
  return found == all.records.end() ? nullptr : found->get();
}

Record* add(Contexts& all, Provider provider, void* display, void* handle, void* share) {
  const Record* other = share ? find(all, provider, share) : nullptr;
  auto record = std::make_unique<Record>();
  record->context.provider = provider;
  record->context.handle = handle;
  record->context.display = display;
  record->context.share_group = other ? other->context.share_group : ++all.share_groups;
  return all.records.emplace_back(std::move(record)).get();
}

// Takes the records out that nobody can use any more.
std::vector<std::unique_ptr<Record>> takeGone(Contexts& all) {
  std::vector<std::unique_ptr<Record>> gone;
  const auto first = std::stable_partition(all.records.begin(), all.records.end(), [](const auto& record) {
    return !record->destroyed || record->threads > 0;
  });
  std::move(first, all.records.end(), std::back_inserter(gone));
  all.records.erase(first, all.records.end());
  return gone;
}

void tellGone(const std::vector<std::unique_ptr<Record>>& gone) {
  for (const auto& record : gone) calls::onContextGone(record->context);
}

void activate(Record* record) {
  active = record;
  currentTable = tableOf(record ? record->context.provider : Provider::none);
}

}  // namespace

const Context* currentContext() {
  return active ? &active->context : nullptr;
}

bool isBound(Provider provider, void* handle) {
  const Record* record = bound[static_cast<int>(provider)];
  return record && record->context.handle == handle;
}

void contextCreated(Provider provider, void* display, void* handle, void* share) {
  if (!handle) return;
  Contexts& all = contexts();
  const std::lock_guard lock(all.mutex);
  // Still known under this address: it went with its display, untold.
  if (Record* former = find(all, provider, handle)) former->destroyed = true;
  add(all, provider, display, handle, share);
}

void contextDestroyed(Provider provider, void* handle) {
  Contexts& all = contexts();
  std::vector<std::unique_ptr<Record>> gone;
  {
    const std::lock_guard lock(all.mutex);
    if (Record* record = find(all, provider, handle)) record->destroyed = true;
    gone = takeGone(all);
  }
  tellGone(gone);
}

void contextMadeCurrent(Provider provider, const Current& current) {
  Contexts& all = contexts();
  Record*& mine = bound[static_cast<int>(provider)];
  std::vector<std::unique_ptr<Record>> gone;
  {
    const std::lock_guard lock(all.mutex);
    Record* record = nullptr;
    if (current.handle) {
      record = find(all, provider, current.handle);
      if (!record) record = add(all, provider, current.display, current.handle, nullptr);
      record->context.draw_drawable = current.draw_drawable;
      record->context.read_drawable = current.read_drawable;
      record->context.width = current.width;
      record->context.height = current.height;
      ++record->threads;
    }
    if (mine) --mine->threads;
    mine = record;
    const auto other = std::ranges::find_if(bound, [](const Record* one) { return one != nullptr; });
    activate(record ? record : other == std::end(bound) ? nullptr : *other);
    gone = takeGone(all);
  }
  tellGone(gone);
  calls::onContextCurrent();
}

}  // namespace shadestep::dispatch
