// The draws that are known: those visited, and those of the frames that were listed.
#include <QElapsedTimer>
#include <algorithm>

#include "debugger-gui/debugger.h"

namespace shadestep::gui {

void Debugger::listFrame(Listing what) {
  if (program_ != Program::stopped) return;
  const session::DrawStop& here = stop_->draw.stop;
  const auto before = listed_.find(here.frame);
  const bool goes_on =
      what == Listing::draws && before != listed_.end() && before->more && before->first <= here.draw;
  list(here.frame, goes_on ? before->last : here.draw, what);
}

void Debugger::list(std::uint64_t frame, std::uint64_t first, Listing what) {
  if (program_ != Program::stopped) return;
  constexpr std::size_t kMostDraws = 10'000, kMostWithMore = 100;
  constexpr qint64 kTellEveryMs = 200;
  struct Batch {
    std::vector<DrawEntry> draws;
    QElapsedTimer age;
  };
  const session::DrawStop here = stop_->draw.stop;
  const ListRequest request{frame, first, what == Listing::draws ? kMostDraws : kMostWithMore, what};
  leaveStop();
  setProgram(Program::running);
  // What is seen on the way is shown at once; of a program that has been left meanwhile it is not.
  const auto tell = [this, which = ++listing_](const std::shared_ptr<Batch>& batch) {
    backend_.tell([this, which, draws = std::exchange(batch->draws, {})] {
      if (which != listing_) return;
      for (const DrawEntry& draw : draws) addDraw(draw);
      Q_EMIT drawsChanged();
    });
    batch->age.start();
  };
  backend_.ask(
      tr("Listing the draws of frame %1").arg(frame), "",
      [this, request, tell](Debuggee& debuggee) {
        auto batch = std::make_shared<Batch>();
        batch->age.start();
        std::size_t seen = 0;
        FrameList listed = debuggee.list(request, [&](const DrawEntry& draw) {
          batch->draws.push_back(draw);
          backend_.reportCount(++seen);
          if (batch->age.elapsed() >= kTellEveryMs) tell(batch);
        });
        tell(batch);
        return listed;
      },
      [this, here, what, which = listing_](const FrameList& list) {
        if (which != listing_) return;
        addList(list);
        Q_EMIT drawsChanged();
        if (list.more) {
          const QString sentence =
              what == Listing::pictures
                  ? tr("Pictures as far as draw %2 of frame %1; scroll on and ask again for more")
              : what == Listing::calls
                  ? tr("Calls as far as draw %2 of frame %1; ask again behind it for more")
                  : tr("Frame %1 is listed as far as draw %2; list it again for more");
          Q_EMIT message(sentence.arg(list.frame).arg(list.last), false);
        }
        goTo(here.frame, here.draw);
      });
}

// A list that goes on where the one before had ended is one with it; one of draws within it says nothing new.
void Debugger::addList(const FrameList& list) {
  if (!listed_.contains(list.frame)) {
    listed_[list.frame] = list;
    return;
  }
  FrameList& known = listed_[list.frame];
  if (known.more && list.first == known.last) {
    for (const auto& [name, count] : list.calls) known.calls[name] += count;
    known.last = list.last;
    known.more = list.more;
    known.behind = list.behind;
  } else if (list.first < known.first || list.last > known.last) {
    const DrawCallsPtr behind = known.behind;
    known = list;
    if (!known.behind) known.behind = behind;
  } else if (list.behind) {
    known.behind = list.behind;
  }
}

void Debugger::addDraw(const DrawEntry& entry) {
  const auto key = [](const DrawEntry& one) { return std::pair(one.stop.frame, one.stop.draw); };
  auto at = std::lower_bound(draws_.begin(), draws_.end(), entry,
                             [&](const DrawEntry& a, const DrawEntry& b) { return key(a) < key(b); });
  if (at != draws_.end() && key(*at) == key(entry)) {
    const DrawEntry before = *at;
    *at = entry;
    if (at->thumbnail.isNull()) at->thumbnail = before.thumbnail;
    if (!at->calls) at->calls = before.calls;
  } else {
    draws_.insert(at, entry);
  }
}

}  // namespace shadestep::gui
