// Draws of a frame, one after the other, with what the program calls between them.
#include <utility>

#include "debugger-gui/backend/debuggee.h"
#include "debugger-gui/backend/process_end.h"

namespace shadestep::gui {

using session::StopReason;

namespace {

// The calls since the last draw, as many as one list keeps in all.
class CallKeeper {
 public:
  void add(const session::LoggedCall& call) {
    // The draw call itself returns only behind its stop.
    if (std::exchange(at_draw_, false) && call.name == draw_) return;
    if (kept_ < kMost) {
      now_.calls.push_back(call);
      ++kept_;
    } else {
      ++now_.left_out;
    }
  }
  // Null: none of them were kept.
  DrawCallsPtr take() {
    DrawCalls before = std::exchange(now_, {});
    if (before.calls.empty() && before.left_out > 0) return nullptr;
    return std::make_shared<const DrawCalls>(std::move(before));
  }
  DrawCallsPtr takeBefore(const session::DrawStop& draw) {
    at_draw_ = true;
    draw_ = draw.call;
    return take();
  }

 private:
  static constexpr std::size_t kMost = 50'000;
  DrawCalls now_;
  std::size_t kept_ = 0;
  bool at_draw_ = false;  // nothing has been told since that draw
  std::string draw_;
};

}  // namespace

// To where no call of the frame has been made yet, or to the program's start.
void Debuggee::goBefore(std::uint64_t frame) {
  if (session_ == nullptr || hasEnded(process_) || std::pair(frame, std::uint64_t{0}) < ahead_)
    start(session::LaunchOptions(launch_));
  leave();
}

// From there on. What is told of meanwhile includes the frame's first call.
void Debuggee::goToFrame(std::uint64_t frame) {
  session::StopCondition begin;
  begin.frame = frame;
  if (session_->runUntil(begin).reason == StopReason::ended) {
    end();
    throw session::Error(session::Outcome::ended, "the program ended before frame " + std::to_string(frame));
  }
  noteCall();
}

// The program goes on to its next draw in that frame, or behind the frame, or is interrupted.
StopReason Debuggee::nextOf(std::uint64_t frame) {
  leave();
  session::StopCondition condition;
  condition.next_draw = true;
  condition.frame = frame + 1;
  const session::Stop found = session_->runUntil(condition);
  if (found.reason == StopReason::ended) {
    end();
    return found.reason;
  }
  noteCall();
  if (!found.draw || found.draw->frame != frame)
    return ahead_.first == frame ? StopReason::interrupted : StopReason::frame;
  stop_ = found.draw;
  ahead_ = {stop_->frame, stop_->draw + 1};
  return StopReason::draw;
}

FrameList Debuggee::list(const ListRequest& request, const std::function<void(const DrawEntry&)>& seen) {
  const bool from_before = request.what == Listing::calls, from_begin = from_before && request.first == 0;
  FrameList list;
  list.frame = request.frame;
  list.first = list.last = request.first;
  std::size_t listed = 0;
  CallKeeper keeper;
  const auto see = [&](bool whole_way) {
    DrawEntry draw = entry();
    if (request.what == Listing::pictures) draw.thumbnail = thumbnail();
    DrawCallsPtr calls = keeper.takeBefore(draw.stop);
    if (whole_way) draw.calls = std::move(calls);
    list.last = draw.stop.draw;
    ++listed;
    seen(draw);
  };
  if (from_begin) {
    goBefore(request.frame);
  } else {
    goTo(request.frame, from_before ? request.first - 1 : request.first);
    if (from_before) {
      keeper.takeBefore(*stop_);
    } else {
      see(false);
      ++list.calls[stop_->call];  // it is under way, and not told of
    }
  }
  calls_.clear();
  const struct Telling {
    Debuggee& debuggee;
    ~Telling() { debuggee.logCalls(debuggee.log_calls_); }
  } telling{*this};
  session::CallFilter filter;
  filter.first_frame = list.frame;
  session_->tellCalls(filter, [&](const session::LoggedCall& call) {
    if (call.frame == list.frame && listed > 0) ++list.calls[call.name];
    if (log_calls_) keep(call);
    if (call.frame == list.frame) keeper.add(call);
  });
  if (from_begin && list.frame > 0) goToFrame(list.frame);
  list.more = true;
  while (listed < request.most && !cancelled_) {
    const StopReason reason = nextOf(list.frame);
    if (reason == StopReason::draw) {
      see(true);
      continue;
    }
    list.more = reason == StopReason::interrupted;
    if (!list.more) list.behind = keeper.take();
    break;
  }
  return list;
}

}  // namespace shadestep::gui
