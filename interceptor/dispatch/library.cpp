// The library's own beginning and end. Runs inside the program under debug.
#include "interceptor/calls/hooks.h"

namespace {

[[gnu::constructor]] void load() {
  shadestep::agent::onLoad();
}
[[gnu::destructor]] void unload() {
  shadestep::agent::onExit();
}

}  // namespace
