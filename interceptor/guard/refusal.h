// Why a request cannot be carried out: one clear sentence for the user.
#pragma once

#include <string>
#include <utility>
#include <variant>

#include "wire/messages_generated.h"

namespace shadestep::guard {

struct Refusal {
  wire::ErrorKind kind = wire::ErrorKind::Unsupported;
  std::string text;
};

template <class T>
using OrRefusal = std::variant<T, Refusal>;

inline Refusal unsupported(std::string text) {
  return {wire::ErrorKind::Unsupported, std::move(text)};
}
inline Refusal limit(std::string text) {
  return {wire::ErrorKind::Limit, std::move(text)};
}
inline Refusal internal(std::string text) {
  return {wire::ErrorKind::Internal, std::move(text)};
}

}  // namespace shadestep::guard
