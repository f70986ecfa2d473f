#include "session/tracer.h"

#include <elf.h>
#include <sys/ptrace.h>
#include <sys/uio.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <future>
#include <set>
#include <sstream>
#include <thread>
#include <utility>

namespace shadestep::session {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kPatience{2};

// ptrace's requests are as good as untyped.
template <class Address, class Data>
bool request(__ptrace_request what, pid_t thread, Address address, Data data) {
  return ptrace(what, thread, address, data) == 0;
}

bool endsByDefault(int signal) {
  constexpr int kCrashes[] = {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT, SIGTRAP, SIGSYS};
  return std::find(std::begin(kCrashes), std::end(kCrashes), signal) != std::end(kCrashes);
}

// Every thread of a process, those that start meanwhile too. Returns errno, 0 if it could.
int seizeAll(pid_t process) {
  std::set<pid_t> seized;
  for (std::size_t before = 1; before != seized.size();) {
    before = seized.size();
    std::error_code error;
    for (const auto& entry : fs::directory_iterator("/proc/" + std::to_string(process) + "/task", error)) {
      const pid_t thread = std::stoi(entry.path().filename().string());
      if (seized.count(thread) != 0) continue;
      if (!request(PTRACE_SEIZE, thread, nullptr, PTRACE_O_TRACECLONE)) {
        if (thread == process) return errno;
        continue;  // it has just ended, or came with a seized thread's clone
      }
      seized.insert(thread);
    }
    if (error || seized.empty()) return ESRCH;
  }
  return 0;
}

template <class Value>
bool readMemory(pid_t thread, std::uint64_t address, Value& value) {
  const iovec to{&value, sizeof value};
  const iovec from{reinterpret_cast<void*>(address), sizeof value};
  return process_vm_readv(thread, &to, 1, &from, 1, 0) == static_cast<ssize_t>(sizeof value);
}

std::string readText(pid_t thread, std::uint64_t address) {
  std::string text;
  char c = 0;
  while (text.size() < 128 && readMemory(thread, address + text.size(), c) && c != 0) text += c;
  return text;
}

// The file mapped at an address, and the offset in it.
std::string placeOf(pid_t thread, std::uint64_t address) {
  std::ifstream maps("/proc/" + std::to_string(thread) + "/maps");
  for (std::string line; std::getline(maps, line);) {
    std::istringstream words(line);
    std::string range, rights, offset, device, inode, path;
    words >> range >> rights >> offset >> device >> inode;
    std::getline(words >> std::ws, path);
    std::uint64_t first = 0, last = 0, start = 0;
    const auto dash = range.find('-');
    std::from_chars(range.data(), range.data() + dash, first, 16);
    std::from_chars(range.data() + dash + 1, range.data() + range.size(), last, 16);
    std::from_chars(offset.data(), offset.data() + offset.size(), start, 16);
    if (address < first || address >= last) continue;
    if (!path.starts_with("/")) return "";
    std::ostringstream place;
    place << fs::path(path).filename().string() << "+0x" << std::hex << address - first + start;
    return place.str();
  }
  return "";
}

// The registers that say where a thread is: its instruction, and where its thread-local memory lies.
#if defined(__x86_64__)
bool readRegisters(pid_t thread, std::uint64_t& instruction, std::uint64_t& thread_pointer) {
  user_regs_struct registers{};
  iovec place{&registers, sizeof registers};
  if (!request(PTRACE_GETREGSET, thread, NT_PRSTATUS, &place)) return false;
  instruction = registers.rip;
  thread_pointer = registers.fs_base;
  return true;
}
#else
bool readRegisters(pid_t, std::uint64_t&, std::uint64_t&) {
  return false;
}
#endif

Crash look(pid_t thread, int signal, std::int64_t call_offset) {
  Crash crash;
  crash.signal = signal;
  crash.thread = thread;
  std::getline(std::ifstream("/proc/" + std::to_string(thread) + "/comm"), crash.thread_name);
  siginfo_t info{};
  if ((signal == SIGSEGV || signal == SIGBUS) && request(PTRACE_GETSIGINFO, thread, nullptr, &info))
    crash.address = reinterpret_cast<std::uintptr_t>(info.si_addr);
  std::uint64_t instruction = 0, thread_pointer = 0;
  if (!readRegisters(thread, instruction, thread_pointer)) return crash;
  crash.place = placeOf(thread, instruction);
  // There lies the address of the call's description, which begins with the address of its name.
  std::uint64_t description = 0, name = 0;
  if (call_offset != 0 &&
      readMemory(thread, thread_pointer + static_cast<std::uint64_t>(call_offset), description) &&
      description != 0 && readMemory(thread, description, name))
    crash.call = readText(thread, name);
  return crash;
}

}  // namespace

void Tracer::handleStop(Shared& shared, pid_t process, pid_t thread, int status) {
  const int signal = WSTOPSIG(status);
  const int event = status >> 16;
  if (event == PTRACE_EVENT_STOP && signal != SIGTRAP) {  // stopped by SIGSTOP or a terminal: it stays so
    request(PTRACE_LISTEN, thread, nullptr, nullptr);
    return;
  }
  if (event != 0) {
    request(PTRACE_CONT, thread, nullptr, nullptr);
    return;
  }
  if (endsByDefault(signal)) {
    const std::lock_guard lock(shared.mutex);
    Traced& traced = shared.processes[process];
    traced.crash = look(thread, signal, traced.call_offset);
  }
  request(PTRACE_CONT, thread, nullptr, static_cast<long>(signal));
}

// Only what this thread traces is waited for; who launched the process learns of its end by itself.
void Tracer::follow(const std::shared_ptr<Shared>& shared, pid_t process) {
  int end_signal = 0;
  while (true) {
    siginfo_t next{};
    if (waitid(P_ALL, 0, &next, WEXITED | WSTOPPED | WNOWAIT | __WALL | __WNOTHREAD) != 0) {
      if (errno == EINTR) continue;
      break;
    }
    const bool ended = next.si_code == CLD_EXITED || next.si_code == CLD_KILLED || next.si_code == CLD_DUMPED;
    if (ended && next.si_pid == process) {
      end_signal = next.si_code == CLD_EXITED ? 0 : next.si_status;
      break;
    }
    int status = 0;
    if (waitpid(next.si_pid, &status, __WALL | __WNOTHREAD) == next.si_pid && WIFSTOPPED(status))
      handleStop(*shared, process, next.si_pid, status);
  }
  const std::lock_guard lock(shared->mutex);
  shared->processes[process].end_signal = end_signal;
  shared->processes[process].running = false;
  shared->ended.notify_all();
}

std::string Tracer::trace(pid_t process, std::int64_t call_offset) {
  {
    const std::lock_guard lock(shared_->mutex);
    Traced& traced = shared_->processes[process];
    traced.call_offset = call_offset;
    if (std::exchange(traced.running, true)) return "";
  }
  // ptrace belongs to the thread that asks for it: one for each process, which ends with it.
  std::promise<int> seized;
  std::future<int> outcome = seized.get_future();
  std::thread([shared = shared_, process, promise = std::move(seized)]() mutable {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, nullptr);
    const int error = seizeAll(process);
    promise.set_value(error);
    if (error == 0) return follow(shared, process);
    const std::lock_guard lock(shared->mutex);
    shared->processes[process].running = false;
  }).detach();
  const int error = outcome.get();
  return error == 0 ? "" : strerror(error);
}

std::optional<Crash> Tracer::crash(pid_t process) const {
  std::unique_lock lock(shared_->mutex);
  const auto found = shared_->processes.find(process);
  if (found == shared_->processes.end()) return std::nullopt;
  const Traced& traced = found->second;
  shared_->ended.wait_for(lock, kPatience, [&] { return !traced.running; });
  const bool died = traced.crash && traced.crash->signal == traced.end_signal;
  return died ? traced.crash : std::nullopt;
}

std::string describe(const Crash& crash) {
  std::ostringstream text;
  text << "thread " << crash.thread;
  if (!crash.thread_name.empty()) text << " (" << crash.thread_name << ")";
  text << " got SIG" << sigabbrev_np(crash.signal);
  if (crash.signal == SIGSEGV || crash.signal == SIGBUS)
    text << " at address 0x" << std::hex << crash.address << std::dec;
  if (!crash.place.empty()) text << ", in " << crash.place;
  if (!crash.call.empty()) text << "; its last OpenGL call: " << crash.call;
  return text.str();
}

}  // namespace shadestep::session
