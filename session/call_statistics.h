// How often a program calls what, frame by frame and in total.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "session/calls.h"

namespace shadestep::session {

struct CallStatistics {
  struct Counts {
    std::map<std::string, std::uint64_t> commands;  // by name
    std::map<std::string, std::uint64_t> origins;   // by commandOrigin of the name
  };

  std::map<std::uint64_t, Counts> frames;
  Counts total;
  std::uint64_t calls = 0, errors = 0;  // all; those that the driver answered with an error

  void add(const LoggedCall&);
};

}  // namespace shadestep::session
