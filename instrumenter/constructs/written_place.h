// The part of a variable or image that a statement writes, where naming it once more changes nothing: what is
// worth recording of memory that other threads see too, and of arrays that are too large to be recorded as a
// whole.
//
//   data[i].mass *= 2.0;          ->   data[i].mass
//   imageStore(img, p, colour);   ->   img[p], the stored colour
#pragma once

#include <optional>
#include <string>

#include "glsl-frontend/shader.h"

namespace shadestep::instrumenter {

struct WrittenPlace {
  frontend::VariableId variable = frontend::kNone;
  std::string name;        // as the user wrote it, without blanks
  std::string expression;  // to be evaluated right behind the statement
  frontend::Type type;
};

// Of an expression statement that is an assignment, an increment or an imageStore.
std::optional<WrittenPlace> writtenPlace(const frontend::Shader&, const frontend::Statement&);

}  // namespace shadestep::instrumenter
