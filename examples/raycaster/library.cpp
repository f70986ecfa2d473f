#include "library.h"

#include <dlfcn.h>

#include <stdexcept>

namespace raycaster {

Library::Library(const char* file, const char* package)
    : handle_(dlopen(file, RTLD_NOW | RTLD_LOCAL)), file_(file) {
  if (!handle_)
    throw std::runtime_error(std::string("cannot open ") + file + " (" + dlerror() +
                             "); install the package " + package);
}

void* Library::symbol(const char* name) const {
  void* const address = dlsym(handle_, name);
  if (!address) throw std::runtime_error(file_ + " has no " + name);
  return address;
}

}  // namespace raycaster
