// What the agent answers to a request of the session.
#pragma once

#include <string>
#include <utility>

#include "interceptor/guard/refusal.h"
#include "wire/messages_generated.h"

namespace shadestep::agent {

struct Reply {
  wire::MessageT message;
  int bulk = -1;  // the memory beside it, by its descriptor; it stays with whoever answers. -1: none
};

template <class Body>
Reply success(Body&& body) {
  Reply reply;
  reply.message.body.Set(std::forward<Body>(body));
  return reply;
}

inline Reply failed(const guard::Refusal& refusal) {
  wire::FailedT failure;
  failure.kind = refusal.kind;
  failure.text = refusal.text;
  return success(std::move(failure));
}

}  // namespace shadestep::agent
