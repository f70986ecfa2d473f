// Watches processes by ptrace: where they crash. Only stops that the kernel makes anyway are looked at
// (signals, new threads); no system call is traced, no memory written. A process that may not be traced (a
// container, yama, a debugger of its own) just runs without; one whose tracer dies runs on.
#pragma once

#include <sys/types.h>

#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace shadestep::session {

// A signal that a thread got and whose default is to end the program. Whether it did, its end tells.
struct Crash {
  int signal = 0;
  pid_t thread = 0;
  std::string thread_name;
  std::uint64_t address = 0;  // that the thread could not access; with SIGSEGV and SIGBUS
  std::string place;          // "libGL.so.1+0x1234": the file that holds the instruction; "" = none
  std::string call;           // the thread's last GL call; "" = none, or not known
};

class Tracer {
 public:
  // Traces a process and all its threads, those to come too, until it ends. Where its interceptor notes the
  // last call: `call_offset` bytes from each thread's thread pointer; 0 = nowhere. Returns "" or why it
  // cannot; a process that is traced already only gets the new offset.
  std::string trace(pid_t process, std::int64_t call_offset);
  // What a traced process that is about to end ended by, if a signal that it got: waits for its end, briefly.
  std::optional<Crash> crash(pid_t process) const;

 private:
  struct Traced {
    std::int64_t call_offset = 0;
    bool running = false;
    int end_signal = 0;
    std::optional<Crash> crash;
  };
  // Outlives the tracer where a process does.
  struct Shared {
    std::mutex mutex;
    std::condition_variable ended;
    std::map<pid_t, Traced> processes;
  };
  static void follow(const std::shared_ptr<Shared>&, pid_t process);
  static void handleStop(Shared&, pid_t process, pid_t thread, int status);

  std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();
};

// "Segmentation fault in thread 71 (render) at address 0x40, in libGL.so.1+0x1234; its last OpenGL call:
// glDrawArrays"
std::string describe(const Crash&);

}  // namespace shadestep::session
