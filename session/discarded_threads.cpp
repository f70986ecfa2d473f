#include "session/discarded_threads.h"

#include <algorithm>
#include <unordered_map>

namespace shadestep::session {
namespace {

struct Nearest {
  const instrumenter::DiscardedThread* thread = nullptr;
  bool several = false;  // equally near
};

}  // namespace

bool severalPlanes(const DrawFacts& facts) {
  return facts.layers > 1 || facts.samples > 1;
}

std::string addDiscarded(ThreadWords& threads, const instrumenter::AttachmentLayout& layout,
                         const instrumenter::DiscardedThreads& discarded, bool from_top) {
  std::unordered_map<std::size_t, Nearest> on_pixel;
  for (const instrumenter::DiscardedThread& thread : discarded.threads) {
    const int y = from_top ? threads.height() - 1 - thread.y : thread.y;
    if (thread.x < 0 || y < 0 || thread.x >= threads.width() || y >= threads.height()) continue;
    Nearest& nearest = on_pixel[threads.index(thread.x, y)];
    if (nearest.thread == nullptr || thread.depth < nearest.thread->depth)
      nearest = {&thread, false};
    else if (!(thread.depth > nearest.thread->depth))
      nearest.several = true;
  }

  std::vector<std::uint32_t> words(static_cast<std::size_t>(threads.words()));
  std::uint64_t unclear = 0;
  for (const auto& [pixel, nearest] : on_pixel) {
    if (instrumenter::decodeMark(layout, threads.head(pixel)) != 0)
      continue;  // the pixel shows another fragment
    if (nearest.several) {
      ++unclear;
      continue;
    }
    std::copy_n(nearest.thread->words, words.size(), words.begin());
    words[0] = instrumenter::encodeMark(
        layout, instrumenter::decodeMark(layout, words.data()) | instrumenter::kDiscarded);
    threads.write(pixel, words.data());
  }
  if (discarded.ended > discarded.threads.size())
    return "of " + std::to_string(discarded.ended) + " threads that end in a discard only " +
           std::to_string(discarded.threads.size()) + " fit into memory; 'debug --pixel' follows any of them";
  if (unclear > 0)
    return "on " + std::to_string(unclear) + (unclear == 1 ? " pixel" : " pixels") +
           " several threads end in a discard at one depth and are left out; 'debug --pixel --hit N' follows "
           "each of them";
  return "";
}

}  // namespace shadestep::session
