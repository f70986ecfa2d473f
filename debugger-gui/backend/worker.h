// One thread that carries out what it is given, in order.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace shadestep::gui {

class Worker {
 public:
  Worker();
  ~Worker();  // finishes what is running, forgets the rest
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  // A task of the same key that still waits is dropped; those without a key all run. Tasks do not throw.
  // Returns how many were dropped.
  std::size_t post(const std::string& key, std::function<void()> task);
  // Runs when nothing else is there to do; only the one given last.
  void postIdle(std::function<void()> task);
  // Waits for what runs, no longer than this; false if it still runs.
  bool idleWithin(std::chrono::milliseconds);
  // Drops all that still wait; returns how many of those posted.
  std::size_t clear();

 private:
  void run();

  struct Task {
    std::string key;
    std::function<void()> run;
  };
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Task> tasks_;
  std::function<void()> idle_;
  bool running_ = false;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace shadestep::gui
