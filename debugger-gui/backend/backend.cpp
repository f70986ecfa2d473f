#include "debugger-gui/backend/backend.h"

namespace shadestep::gui {
namespace {
constexpr qint64 kReportEveryMs = 50;
}

Backend::Backend(QObject* parent) : QObject(parent), worker_(std::make_unique<Worker>()) {
  last_report_.start();
}

Backend::~Backend() {
  constexpr std::chrono::milliseconds kPatience{1000};
  worker_->clear();
  debuggee_.close();
  if (!worker_->idleWithin(kPatience)) debuggee_.endWait();
  worker_.reset();  // waits for what runs; nothing of it is delivered any more
}

void Backend::enqueue(const QString& what, const std::string& key,
                      std::function<std::function<void()>()> work) {
  ++outstanding_;
  const std::size_t dropped = worker_->post(key, [this, what, work = std::move(work)] {
    debuggee_.clearCancel();
    tell([this, what] {
      current_ = what;
      Q_EMIT started(what);
    });
    std::function<void()> deliver;
    try {
      deliver = work();
    } catch (const session::Error& error) {
      const QString sentence = QString::fromStdString(error.what());
      deliver = [this, what, sentence, outcome = error.outcome()] { Q_EMIT failed(what, sentence, outcome); };
    } catch (const std::exception& error) {
      const QString sentence = QString::fromUtf8(error.what());
      deliver = [this, what, sentence] { Q_EMIT failed(what, sentence, session::Outcome::failed); };
    }
    tell([this, deliver = std::move(deliver)] {
      deliver();
      finish();
    });
  });
  outstanding_ -= static_cast<int>(dropped);
}

void Backend::whenIdle(std::function<void(Debuggee&)> work) {
  worker_->postIdle([this, work = std::move(work)] {
    try {
      work(debuggee_);
    } catch (const std::exception&) {
    }
  });
}

void Backend::finish() {
  --outstanding_;
  if (outstanding_ > 0) return;
  current_.clear();
  Q_EMIT becameIdle();
}

void Backend::cancel() {
  outstanding_ -= static_cast<int>(worker_->clear());
  debuggee_.cancel();
}

void Backend::stopRunning() {
  debuggee_.cancel();
  debuggee_.interrupt();
}

void Backend::endProgramNow() {
  outstanding_ -= static_cast<int>(worker_->clear());
  debuggee_.endWait();
}

void Backend::tell(std::function<void()> what_to_do) {
  QMetaObject::invokeMethod(this, std::move(what_to_do), Qt::QueuedConnection);
}

void Backend::report(double share) {
  if (last_report_.elapsed() < kReportEveryMs && share < 1) return;
  last_report_.restart();
  tell([this, share] { Q_EMIT progress(share); });
}

void Backend::reportCount(std::size_t done) {
  if (last_report_.elapsed() < kReportEveryMs) return;
  last_report_.restart();
  tell([this, done] { Q_EMIT counted(done); });
}

}  // namespace shadestep::gui
