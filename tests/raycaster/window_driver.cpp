// Sits before the ray caster's window as a user does: starts the program in argv[1] with the rest of the
// arguments, turns, zooms, changes the preset, and leaves by `q` and by closing the window. Needs an X
// server. Exit status: 0 all of it did what it should, else 1 with the reason.
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/keysym.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <iostream>
#include <stdexcept>
#include <string>

namespace {

constexpr int kPatience = 60'000;  // milliseconds for what takes some

class Visitor {
 public:
  explicit Visitor(char** command) : display_(XOpenDisplay(nullptr)) {
    if (!display_) throw std::runtime_error("there is no X server");
    XSelectInput(display_, DefaultRootWindow(display_), SubstructureNotifyMask);
    XSync(display_, False);
    child_ = fork();
    if (child_ == 0) {
      execv(command[0], command);
      _exit(127);
    }
    while (window_ == None) {
      const XEvent event = next("a window");
      if (event.type == CreateNotify) window_ = event.xcreatewindow.window;
    }
    XSelectInput(display_, window_, PropertyChangeMask);
    until("a first frame", [this] { return title().starts_with("raycaster: "); });
  }
  ~Visitor() {
    if (child_ > 0) kill(child_, SIGKILL);
    XCloseDisplay(display_);
  }
  Visitor(const Visitor&) = delete;
  Visitor& operator=(const Visitor&) = delete;

  void key(KeySym symbol) {
    XEvent event{};
    event.xkey.type = KeyPress;
    event.xkey.root = DefaultRootWindow(display_);
    event.xkey.keycode = XKeysymToKeycode(display_, symbol);
    event.xkey.state = shiftOf(symbol);
    send(event, KeyPressMask);
  }
  void button(unsigned number, int x, int y) {
    XEvent event{};
    event.xbutton.type = ButtonPress;
    event.xbutton.button = number;
    event.xbutton.x = x;
    event.xbutton.y = y;
    send(event, ButtonPressMask);
  }
  void drag(int x, int y) {
    XEvent event{};
    event.xmotion.type = MotionNotify;
    event.xmotion.state = Button1Mask;
    event.xmotion.x = x;
    event.xmotion.y = y;
    send(event, Button1MotionMask);
  }
  void close() {
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.message_type = XInternAtom(display_, "WM_PROTOCOLS", False);
    event.xclient.format = 32;
    event.xclient.data.l[0] = static_cast<long>(XInternAtom(display_, "WM_DELETE_WINDOW", False));
    send(event, NoEventMask);
  }

  // Without the frame's time.
  std::string title() {
    char* name = nullptr;
    if (XFetchName(display_, window_, &name) == 0 || !name) return "";
    const std::string text = name;
    XFree(name);
    return text.substr(0, text.rfind(" - "));
  }
  std::string picture() {
    XWindowAttributes size;
    XGetWindowAttributes(display_, window_, &size);
    XImage* const image = XGetImage(display_, window_, 0, 0, static_cast<unsigned>(size.width),
                                    static_cast<unsigned>(size.height), AllPlanes, ZPixmap);
    if (!image) throw std::runtime_error("the window has no picture");
    std::string bytes(image->data, static_cast<std::size_t>(image->bytes_per_line * image->height));
    XDestroyImage(image);
    return bytes;
  }

  // The program sets its title after each frame: so it is asked then.
  void until(const char* what, const std::function<bool()>& true_now) {
    while (!true_now()) next(what);
  }
  int exitStatus() {
    int status = 0;
    waitpid(child_, &status, 0);
    child_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  static unsigned shiftOf(KeySym symbol) { return symbol == XK_plus ? ShiftMask : 0; }

  void send(XEvent& event, long mask) {
    event.xany.display = display_;
    event.xany.window = window_;
    XSendEvent(display_, window_, False, mask, &event);
    XFlush(display_);
  }
  XEvent next(const char* what) {
    pollfd readable{ConnectionNumber(display_), POLLIN, 0};
    if (XPending(display_) == 0 && poll(&readable, 1, kPatience) == 0)
      throw std::runtime_error(std::string("waited in vain for ") + what);
    XEvent event;
    XNextEvent(display_, &event);
    return event;
  }

  Display* display_;
  pid_t child_ = -1;
  Window window_ = None;
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
  const std::string title = visitor.title();
  require(title.find("step 1/") != std::string::npos, "the title does not tell the plan: " + title);
  changesThePicture("the turned picture", [&] {
    visitor.button(1, 10, 10);
    visitor.drag(40, 25);
  });
  changesThePicture("the nearer picture", [&] { visitor.button(4, 10, 10); });
  changesThePicture("the nearest picture", [&] { visitor.key(XK_plus); });
  require(visitor.title() == title, "turning changed what is drawn: " + visitor.title());
  changesThePicture("the next preset", [&] { visitor.key(XK_space); });
  visitor.until("its title", [&] { return visitor.title() != title; });
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
