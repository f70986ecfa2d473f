#include "debugger-gui/backend/worker.h"

#include <algorithm>
#include <utility>

namespace shadestep::gui {

Worker::Worker() : thread_([this] { run(); }) {}

Worker::~Worker() {
  {
    const std::lock_guard lock(mutex_);
    tasks_.clear();
    idle_ = nullptr;
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

std::size_t Worker::post(const std::string& key, std::function<void()> task) {
  std::size_t dropped = 0;
  {
    const std::lock_guard lock(mutex_);
    if (!key.empty()) dropped = std::erase_if(tasks_, [&](const Task& one) { return one.key == key; });
    tasks_.push_back({key, std::move(task)});
  }
  changed_.notify_all();
  return dropped;
}

void Worker::postIdle(std::function<void()> task) {
  {
    const std::lock_guard lock(mutex_);
    idle_ = std::move(task);
  }
  changed_.notify_all();
}

bool Worker::idleWithin(std::chrono::milliseconds most) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, most, [this] { return !running_ && tasks_.empty(); });
}

std::size_t Worker::clear() {
  const std::lock_guard lock(mutex_);
  const std::size_t dropped = tasks_.size();
  tasks_.clear();
  idle_ = nullptr;
  return dropped;
}

void Worker::run() {
  while (true) {
    Task task;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return ending_ || !tasks_.empty() || idle_; });
      if (!tasks_.empty()) {
        task = std::move(tasks_.front());
        tasks_.pop_front();
      } else if (idle_) {
        task.run = std::exchange(idle_, nullptr);
      } else {
        return;
      }
      running_ = true;
    }
    task.run();
    const std::lock_guard lock(mutex_);
    running_ = false;
    changed_.notify_all();
  }
}

}  // namespace shadestep::gui
