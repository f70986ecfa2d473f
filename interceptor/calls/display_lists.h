// Display lists: draws that are only compiled are none, and a list that is called may change state, which a
// replay of it puts back. Runs inside the program under debug: throws nothing, starts no thread, calls GL
// only through dispatch::gl().
#pragma once

#include <string>

#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::calls {

// Between glNewList and glEndList of the current context.
bool compilingList();
// The same, with GL_COMPILE: nothing is carried out.
bool compilesOnly();

// Why calls of lists cannot be replayed in the current context, or "": what one of them holds cannot be put
// back, or there is no room to keep it in.
std::string listObstacle();

// All state that a display list can change, unless there is a listObstacle.
class ListStateGuard {
 public:
  ListStateGuard();
  ~ListStateGuard();
  ListStateGuard(const ListStateGuard&) = delete;
  ListStateGuard& operator=(const ListStateGuard&) = delete;

 private:
  static constexpr int kTextureUnits = 32;
  struct Matrix {
    GLint depth = 0;
    GLfloat values[16] = {};
  };
  GLint depth_ = 0;  // of the attribute stack
  GLint matrix_mode_ = 0;
  int units_ = 0;
  Matrix modelview_, projection_, textures_[kTextureUnits];
};

template <class Call>
void restoringListState(Call call) {
  const ListStateGuard guard;
  call();
}

}  // namespace shadestep::calls
