// The thread whose values are looked at, and whose way is followed.
#pragma once

#include <QString>
#include <optional>

#include "session/thread_values.h"

namespace shadestep::gui {

struct Pixel {
  int x = 0, y = 0;
  bool operator==(const Pixel&) const = default;
};

// Of the fragment stage a pixel, of another stage a thread by its numbers. None may be picked.
struct Picked {
  session::Stage stage = session::Stage::fragment;
  std::optional<Pixel> pixel;
  session::ThreadName thread;  // empty: none
  bool any() const { return stage == session::Stage::fragment ? pixel.has_value() : !thread.empty(); }
  bool operator==(const Picked&) const = default;
  // Among these values; nothing if it is not there.
  std::optional<std::size_t> in(const session::ThreadValues&) const;
};

// The name by which ThreadValues::find gives this thread again; of another stage than the fragment stage.
session::ThreadName nameOf(const session::ThreadValues&, std::size_t thread);
// "vertex 7, instance 0"
QString textOf(const session::ThreadName&);

}  // namespace shadestep::gui
