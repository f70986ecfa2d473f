// Linked with no GL: a plug-in that is, opened with RTLD_DEEPBIND. The flag keeps its meaning for other
// names.
#include "loader.h"

// The plug-in must call its own.
extern "C" const char* plugin_name() {
  return "the program's";
}

int main(int, char** arguments) {
  char path[4096];
  const char* slash = std::strrchr(arguments[0], '/');
  loader::require(slash, "start with a path");
  std::snprintf(path, sizeof path, "%.*s/libloader-plugin.so", static_cast<int>(slash - arguments[0]),
                arguments[0]);
  void* plugin = dlopen(path, RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND);
  loader::require(plugin, dlerror());
  const auto run = reinterpret_cast<const char* (*)()>(dlsym(plugin, "plugin_run"));
  std::printf("called: %s\n", run());
  std::printf("missing: %s\n", dlopen("/no/such/library.so", RTLD_NOW | RTLD_DEEPBIND) ? "found" : "null");
  std::printf("error: %s\n", dlerror() ? "yes" : "no");
}
