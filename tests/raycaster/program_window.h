// A program's window on the X server, seen and used from outside as its user does.
#pragma once

#include <functional>
#include <string>

struct _XDisplay;
union _XEvent;

namespace shadestep::test {

class ProgramWindow {
 public:
  // Throws std::runtime_error where there is no X server.
  ProgramWindow();
  ~ProgramWindow();
  ProgramWindow(const ProgramWindow&) = delete;
  ProgramWindow& operator=(const ProgramWindow&) = delete;

  // Waits for a window whose title begins like this; the following is for it.
  void find(const std::string& title);

  void key(unsigned long symbol);  // XK_...
  void button(unsigned number, int x, int y);
  void drag(int x, int y);
  void close();
  std::string title() const;
  std::string picture() const;  // bytes that differ where the pixels do
  // Until it is true; asked whenever the window's title is set. Throws std::runtime_error if it takes too
  // long.
  void until(const char* what, const std::function<bool()>& true_now);

 private:
  std::string titleOf(unsigned long window) const;
  void send(_XEvent& event, long mask);
  _XEvent next(const char* what);

  _XDisplay* display_;
  unsigned long window_ = 0;
};

}  // namespace shadestep::test
