// The program under debug as the worker thread sees it: one Session after another, and what stands on its
// stop. Used on the worker thread alone, except where it says otherwise. Throws session::Error.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "debugger-gui/backend/snapshots.h"

namespace shadestep::gui {

// Larger values are looked at when somebody asks for them.
inline constexpr int kLargeWords = 16;

enum class Move { over, into, out, next_iteration, leave_loop };

struct CostRequest {
  std::string method = "auto";
  double budget = 12;      // seconds
  std::string compare_to;  // profile.json of an earlier run; empty: none
};

class Debuggee {
 public:
  ~Debuggee();

  // Ends the program that runs, if any, and starts this one; it runs until goTo.
  void start(const session::LaunchOptions&);
  void end();
  bool running() const { return session_ != nullptr; }

  // Starts the program again where it has passed the draw, or has ended.
  Stop goTo(std::uint64_t frame, std::uint64_t draw);
  // Runs until one of the conditions holds, the program ends, or interrupt().
  Halt runUntil(const session::StopCondition&);
  // The call at which the program waits; nothing where it does not.
  std::optional<session::CallStop> call() const;
  std::string setArgument(const std::string& name, const std::string& value);
  void skipCall();
  // From now on Halt::calls tells of the program's calls, or no longer.
  void logCalls(bool on);
  // From that draw on; cancel and interrupt end it early. With pictures every draw is replayed once. What led
  // to the draws is told with them as far as it was called behind the first stop.
  FrameList list(const ListRequest&, const std::function<void(const DrawEntry&)>& seen);
  // Lets the program go on to its own end; its exit status.
  int runToEnd();

  void pick(const Picked&);
  // At the start of main of its stage.
  Place restartShader(const Picked&);
  Place move(Move);
  Place moveTo(const session::Position&);
  Place toLine(int line);
  Place choose(const std::string& side);
  // `run`: the picked thread's recorded way; null: not known.
  LookPtr look(const std::vector<std::string>& expressions, const RunPtr& run = nullptr);
  // Looks at where a step over leads: then it takes no draw any more.
  void lookAhead(const std::vector<std::string>& watches);
  RunPtr followPicked();
  OriginPtr origin(Pixel, session::Stage);  // of the pixel's fragment; the stage that is looked at stays
  EmitsPtr emits();                         // of the draw's geometry shader

  void chooseFragments(const session::FragmentChoice&);
  TargetPtr target();
  LoopsPtr loops();
  ProfilePtr profile(const CostRequest&, const std::function<void(double)>& progress);
  GlState glState();
  TextureListPtr textures();  // of the fragment shader
  TexturePtr texture(const std::string& uniform, int level, int slice);
  BufferListPtr buffers();
  BufferPtr buffer(const session::BoundBuffer&);

  // Any thread: asks what takes long to stop, and ends a wait for a program that does not get to where it
  // should, with the program.
  void cancel() { cancelled_ = true; }
  void endWait();    // asked for a second time, the program is not asked any more
  void close();      // endWait, and no program starts after it
  void interrupt();  // stops a running program at its next call
  bool cancelled() const { return cancelled_; }
  void clearCancel() { cancelled_ = false; }
  int process() const { return process_; }  // 0: none

 private:
  Stop stopped(bool restarted);
  void runTo(std::uint64_t frame, std::uint64_t draw);
  void leave();
  void goBefore(std::uint64_t frame);
  void goToFrame(std::uint64_t frame);
  session::StopReason nextOf(std::uint64_t frame);
  void noteCall();
  void keep(const session::LoggedCall&);
  DrawEntry entry();
  TargetPtr drawnTarget(bool compare);
  QImage thumbnail();
  std::string whyNot(session::Stage);
  session::Stepper& stepper();
  LookPtr lookFrom(session::Stepper&, const std::vector<std::string>& expressions, const RunPtr&) const;
  static std::vector<ScopeEntry> scopeOf(const session::Stepper&);
  session::Session& atDraw();
  Place place();
  std::optional<session::ThreadName> pickedThread() const;

  session::LaunchOptions launch_;
  std::unique_ptr<session::Session> session_;
  std::unique_ptr<session::Stepper> stepper_;
  int slow_ahead_ = 0;  // how often in a row looking ahead took too long
  std::optional<session::DrawStop> stop_;
  std::pair<std::uint64_t, std::uint64_t> ahead_;  // the first frame and draw that the program has not passed
  std::vector<session::LoggedCall> calls_;         // since the last halt
  bool log_calls_ = false;
  Picked picked_;
  session::FragmentChoice fragments_;
  std::optional<profiler::Earlier> earlier_;
  std::atomic<bool> cancelled_ = false;
  std::atomic<bool> closed_ = false;
  std::atomic<int> process_ = 0;
  std::atomic<int> asked_to_end_ = 0;  // the process that endWait has asked
  std::mutex interruptible_mutex_;
  session::Session* interruptible_ = nullptr;  // session_, for interrupt()
};

}  // namespace shadestep::gui
