// What samplers read at this draw: the answer to DescribeTextures.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include "interceptor/agent/describe.h"
#include "wire/messages_generated.h"

namespace shadestep::agent {

// The context is as before afterwards.
wire::TexturesT describeTextures(const DrawFacts&, const wire::DescribeTexturesT&);

}  // namespace shadestep::agent
