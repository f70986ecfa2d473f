#include "program_window.h"

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/keysym.h>
#include <poll.h>

#include <stdexcept>

namespace shadestep::test {
namespace {

constexpr int kPatience = 60'000;  // milliseconds for what takes some

// Other windows may be gone before they are asked for their title.
int ignoreError(Display*, XErrorEvent*) {
  return 0;
}

}  // namespace

ProgramWindow::ProgramWindow() : display_(XOpenDisplay(nullptr)) {
  if (!display_) throw std::runtime_error("there is no X server");
  XSetErrorHandler(ignoreError);
  XSelectInput(display_, DefaultRootWindow(display_), SubstructureNotifyMask);
  XSync(display_, False);
}

ProgramWindow::~ProgramWindow() {
  XCloseDisplay(display_);
}

void ProgramWindow::find(const std::string& title) {
  const auto look = [&](::Window window) {
    XSelectInput(display_, window, PropertyChangeMask);
    if (titleOf(window).starts_with(title)) window_ = window;
  };
  ::Window root = None, parent = None, *there = nullptr;
  unsigned count = 0;
  XQueryTree(display_, DefaultRootWindow(display_), &root, &parent, &there, &count);
  for (unsigned i = 0; i < count; ++i) look(there[i]);
  if (there) XFree(there);
  while (window_ == None) {
    const XEvent event = next("a window");
    if (event.type == CreateNotify) look(event.xcreatewindow.window);
    if (event.type == PropertyNotify) look(event.xproperty.window);
  }
}

void ProgramWindow::key(unsigned long symbol) {
  XEvent event{};
  event.xkey.type = KeyPress;
  event.xkey.root = DefaultRootWindow(display_);
  event.xkey.keycode = XKeysymToKeycode(display_, symbol);
  event.xkey.state = symbol == XK_plus ? ShiftMask : 0;
  send(event, KeyPressMask);
}

void ProgramWindow::button(unsigned number, int x, int y) {
  XEvent event{};
  event.xbutton.type = ButtonPress;
  event.xbutton.button = number;
  event.xbutton.x = x;
  event.xbutton.y = y;
  send(event, ButtonPressMask);
}

void ProgramWindow::drag(int x, int y) {
  XEvent event{};
  event.xmotion.type = MotionNotify;
  event.xmotion.state = Button1Mask;
  event.xmotion.x = x;
  event.xmotion.y = y;
  send(event, Button1MotionMask);
}

void ProgramWindow::close() {
  XEvent event{};
  event.xclient.type = ClientMessage;
  event.xclient.message_type = XInternAtom(display_, "WM_PROTOCOLS", False);
  event.xclient.format = 32;
  event.xclient.data.l[0] = static_cast<long>(XInternAtom(display_, "WM_DELETE_WINDOW", False));
  send(event, NoEventMask);
}

std::string ProgramWindow::title() const {
  return titleOf(window_);
}

std::string ProgramWindow::picture() const {
  XWindowAttributes size;
  if (XGetWindowAttributes(display_, window_, &size) == 0) throw std::runtime_error("the window is gone");
  XImage* const image = XGetImage(display_, window_, 0, 0, static_cast<unsigned>(size.width),
                                  static_cast<unsigned>(size.height), AllPlanes, ZPixmap);
  if (!image) throw std::runtime_error("the window has no picture");
  std::string bytes(image->data, static_cast<std::size_t>(image->bytes_per_line * image->height));
  XDestroyImage(image);
  return bytes;
}

void ProgramWindow::until(const char* what, const std::function<bool()>& true_now) {
  while (!true_now()) next(what);
}

std::string ProgramWindow::titleOf(unsigned long window) const {
  char* name = nullptr;
  if (XFetchName(display_, window, &name) == 0 || !name) return "";
  const std::string text = name;
  XFree(name);
  return text;
}

void ProgramWindow::send(XEvent& event, long mask) {
  event.xany.display = display_;
  event.xany.window = window_;
  XSendEvent(display_, window_, False, mask, &event);
  XFlush(display_);
}

XEvent ProgramWindow::next(const char* what) {
  pollfd readable{ConnectionNumber(display_), POLLIN, 0};
  if (XPending(display_) == 0 && poll(&readable, 1, kPatience) == 0)
    throw std::runtime_error(std::string("waited in vain for ") + what);
  XEvent event;
  XNextEvent(display_, &event);
  return event;
}

}  // namespace shadestep::test
