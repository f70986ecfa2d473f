// No OpenGL at all.
#include <cstdio>

int main() {
  return std::puts("no OpenGL here") < 0;
}
