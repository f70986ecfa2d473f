// A shared library opened at run time.
#pragma once

#include <string>

namespace raycaster {

// The window-system libraries are opened when a context of their kind is asked for, not linked: the program
// then starts on a machine without X (OSMesa) or without OSMesa (GLX, EGL), and one binary shows all three.
// Never closed: drivers do not expect to be unloaded.
class Library {
 public:
  // Throws std::runtime_error that names the Debian package to install.
  Library(const char* file, const char* package);

  // Sets `function` to the symbol's address; throws if there is none.
  template <class Function>
  void load(Function& function, const char* name) const {
    function = reinterpret_cast<Function>(symbol(name));
  }

 private:
  void* symbol(const char* name) const;
  void* handle_;
  std::string file_;
};

}  // namespace raycaster
