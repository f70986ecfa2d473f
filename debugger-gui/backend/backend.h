// Requests to the debuggee, carried out on a thread of their own, so that the window never waits; their
// results come back to the main thread.
#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QString>
#include <memory>
#include <type_traits>
#include <utility>

#include "debugger-gui/backend/debuggee.h"
#include "debugger-gui/backend/worker.h"

namespace shadestep::gui {

class Backend : public QObject {
  Q_OBJECT
 public:
  explicit Backend(QObject* parent = nullptr);
  ~Backend() override;  // ends the program under debug

  // `work(Debuggee&)` runs on the worker thread, `done(result)` then here. A request of the same `key` that
  // still waits is forgotten; "" = none. `what` is what the user reads meanwhile.
  template <class Work, class Done>
  void ask(const QString& what, const std::string& key, Work work, Done done) {
    enqueue(what, key, [this, work, done]() -> std::function<void()> {
      if constexpr (std::is_void_v<std::invoke_result_t<Work, Debuggee&>>) {
        work(debuggee_);
        return done;
      } else {
        auto result = std::make_shared<std::invoke_result_t<Work, Debuggee&>>(work(debuggee_));
        return [done, result] { done(std::move(*result)); };
      }
    });
  }

  // Runs on the worker thread when nothing else is asked; only the one given last. Nobody waits for it, and
  // what goes wrong there goes wrong again when it is asked for.
  void whenIdle(std::function<void(Debuggee&)> work);

  bool idle() const { return outstanding_ == 0; }
  QString current() const { return current_; }
  // Forgets what waits; what runs is asked to stop.
  void cancel();
  void interrupt() { debuggee_.interrupt(); }
  // What runs is asked to stop, and the program with it; what waits stays.
  void stopRunning();
  // The same, and ends the program where the wait is for it.
  void endProgramNow();
  int process() const { return debuggee_.process(); }
  // From the worker thread: what to do here.
  void tell(std::function<void()> what_to_do);
  // Shares done, from the worker thread.
  void report(double share);
  void reportCount(std::size_t done);  // of work whose end is not known

 Q_SIGNALS:
  void started(const QString& what);
  void becameIdle();
  void progress(double share);
  void counted(qulonglong done);
  void failed(const QString& what, const QString& sentence, shadestep::session::Outcome);

 private:
  void enqueue(const QString& what, const std::string& key, std::function<std::function<void()>()> work);
  void finish();

  Debuggee debuggee_;
  int outstanding_ = 0;  // asked, and neither answered nor forgotten
  QString current_;
  QElapsedTimer last_report_;
  std::unique_ptr<Worker> worker_;
};

}  // namespace shadestep::gui
