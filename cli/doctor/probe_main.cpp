// shadestep-doctor-probe PROVIDER [timers]: what one provider of OpenGL offers here, as one JSON document;
// with `timers`, also whether its clocks can be trusted, which takes some seconds. A process of its own,
// because drivers crash; run bare and under the interceptor by `shadestep doctor`.
#include <dlfcn.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/doctor/probe_timers.h"

namespace {

using namespace shadestep::doctor;
using Json = nlohmann::ordered_json;

// The library that a function's address lies in.
std::string libraryOf(void* function) {
  Dl_info info{};
  return dladdr(function, &info) != 0 && info.dli_fname != nullptr ? info.dli_fname : "";
}

Json describeTimers(const std::vector<TimerTest>& tests) {
  Json timers = Json::array();
  for (const TimerTest& test : tests)
    timers.push_back({{"name", test.name},
                      {"present", test.present},
                      {"trusted", test.trusted()},
                      {"share_of_wall", test.share_of_wall},
                      {"once", test.once},
                      {"twice", test.twice},
                      {"thrice", test.thrice}});
  return timers;
}

Json describeContext(const ProbeContext& context, bool with_timers) {
  const Gl gl(context);
  const std::vector<std::string> extensions = gl.extensions();
  const bool clock =
      std::find(extensions.begin(), extensions.end(), "GL_ARB_shader_clock") != extensions.end();
  Json facts;
  facts["version"] = gl.string(GL_VERSION);
  facts["glsl"] = gl.string(GL_SHADING_LANGUAGE_VERSION);
  facts["renderer"] = gl.string(GL_RENDERER);
  facts["vendor"] = gl.string(GL_VENDOR);
  facts["extensions"] = extensions;
  facts["draw_from"] = libraryOf(context.function("glDrawArrays"));
  if (with_timers) facts["timers"] = describeTimers(testTimers(gl, clock));
  return facts;
}

}  // namespace

int main(int argc, char** argv) {
  const Provider provider = providerByName(argc >= 2 ? argv[1] : "");
  const bool with_timers = argc == 3 && std::string(argv[2]) == "timers";
  if (!provider.create || argc > (with_timers ? 3 : 2)) {
    std::cerr << "usage: shadestep-doctor-probe osmesa|egl|glx [timers]\n";
    return 2;
  }
  Json document;
  document["provider"] = provider.name;
  for (const auto& [profile, name] :
       {std::pair{Profile::core, "core"}, std::pair{Profile::compatibility, "compatibility"},
        std::pair{Profile::es, "es"}}) {
    std::string error;
    const std::unique_ptr<ProbeContext> context = provider.create(profile, error);
    document["contexts"][name] = context != nullptr
                                     ? describeContext(*context, with_timers && profile == Profile::core)
                                     : Json{{"error", error}};
  }
  std::cout << document.dump(1, ' ', false, Json::error_handler_t::replace) << std::endl;
  // Drivers' exit handlers are not under test here.
  std::quick_exit(0);
}
