// Sits before the ray caster's window as a user does: starts the program in argv[1] with the rest of the
// arguments, turns, zooms, changes the preset, and leaves by `q` and by closing the window. Needs an X
// server. Exit status: 0 all of it did what it should, else 1 with the reason.
#include <X11/keysym.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <iostream>
#include <stdexcept>
#include <string>

#include "program_window.h"

namespace {

class Visitor : public shadestep::test::ProgramWindow {
 public:
  explicit Visitor(char** command) : child_(fork()) {
    if (child_ == 0) {
      execv(command[0], command);
      _exit(127);
    }
    find("raycaster: ");  // once there is a first frame
  }
  ~Visitor() {
    if (child_ > 0) kill(child_, SIGKILL);
  }

  // Without the frame's time.
  std::string plan() const { return title().substr(0, title().rfind(" - ")); }
  int exitStatus() {
    int status = 0;
    waitpid(child_, &status, 0);
    child_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  pid_t child_;
};

void require(bool holds, const std::string& what) {
  if (!holds) throw std::runtime_error(what);
}

void look(char** command) {
  Visitor visitor(command);
  const auto changesThePicture = [&](const char* what, const std::function<void()>& act) {
    const std::string before = visitor.picture();
    act();
    visitor.until(what, [&] { return visitor.picture() != before; });
  };
  const std::string title = visitor.plan();
  require(title.find("step 1/") != std::string::npos, "the title does not tell the plan: " + title);
  changesThePicture("the turned picture", [&] {
    visitor.button(1, 10, 10);
    visitor.drag(40, 25);
  });
  changesThePicture("the nearer picture", [&] { visitor.button(4, 10, 10); });
  changesThePicture("the nearest picture", [&] { visitor.key(XK_plus); });
  require(visitor.plan() == title, "turning changed what is drawn: " + visitor.plan());
  changesThePicture("the next preset", [&] { visitor.key(XK_space); });
  visitor.until("its title", [&] { return visitor.plan() != title; });
  visitor.key(XK_q);
  require(visitor.exitStatus() == 0, "`q` does not end it well");

  Visitor other(command);
  other.close();
  require(other.exitStatus() == 0, "closing the window does not end it well");
}

}  // namespace

int main(int, char** argv) {
  try {
    look(argv + 1);
    return 0;
  } catch (const std::exception& error) {
    std::cout << error.what() << '\n';
    return 1;
  }
}
