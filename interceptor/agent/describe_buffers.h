// The memory that this draw reads and writes through buffers: the answers to DescribeBuffers and ReadBuffer.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include "interceptor/agent/answer_memory.h"
#include "interceptor/agent/describe.h"
#include "interceptor/guard/refusal.h"
#include "wire/messages_generated.h"

namespace shadestep::agent {

// Blocks and atomic counters of the draw's programs with their members, the vertex attributes that they read,
// and the buffers of indices, indirect commands and active transform feedback. The context is as before
// afterwards.
guard::OrRefusal<wire::BuffersT> describeBuffers(const DrawFacts&);

// What stands there before the draw. The context is as before afterwards.
guard::OrRefusal<wire::BufferBytesT> readBuffer(const DrawFacts&, const wire::ReadBufferT&,
                                                AnswerMemory& bulk);

}  // namespace shadestep::agent
