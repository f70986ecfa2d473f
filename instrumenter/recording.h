// The choice that instrumentRecording of instrumenter.h leaves to itself.
#pragma once

#include "instrumenter/instrumenter.h"

namespace shadestep::instrumenter {

// What threads run that are not recorded.
enum class Others {
  plain_copies,  // the user's functions without instrumentation: they cost next to nothing
  the_same,  // all threads run the same text. llvmpipe counts the iterations of a group of threads together
             // and ends loops at 65,536: two copies of a loop would share them
};
Result<RecordingShader> instrumentRecording(const frontend::Shader&, const Target&, Others);

}  // namespace shadestep::instrumenter
