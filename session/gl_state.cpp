// The state of the program's context, as a person reads it.
#include <sstream>

#include "session/session_state.h"

namespace shadestep::session {
namespace {

// Whether these integers are these floats: then nothing was cut off. (A float has fewer digits: the integers
// say more.)
bool sameAsFloats(const std::string& integers, const std::string& floats) {
  std::istringstream some(integers), others(floats);
  long long integer = 0;
  float real = 0;
  while (some >> integer)
    if (!(others >> real) || static_cast<float>(integer) != real) return false;
  return !(others >> real);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> Session::glState() {
  const auto [reply, bulk] = state_->ask<wire::StateT>(wire::DescribeStateT{});
  std::vector<std::pair<std::string, std::string>> values;
  for (const auto& one : reply.values) {
    const bool again = !values.empty() && values.back().first == one->name;
    if (!again)
      values.emplace_back(one->name, one->value);
    else if (!sameAsFloats(values.back().second, one->value))
      values.back().second = one->value;
  }
  return values;
}

}  // namespace shadestep::session
