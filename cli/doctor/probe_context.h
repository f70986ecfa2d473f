// A context of one provider for the probe, made without linking it: what is not installed must not stop the
// probe.
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace shadestep::doctor {

enum class Profile { core, compatibility, es };

class ProbeContext {
 public:
  virtual ~ProbeContext() = default;
  // The address that the provider's GetProcAddress gives.
  virtual void* function(const char* name) const = 0;
};

struct Provider {
  std::string name;  // "osmesa", "egl", "glx"
  // A current context of the highest version of this profile, or null with the reason in `error`.
  std::function<std::unique_ptr<ProbeContext>(Profile, std::string& error)> create;
};

// The provider of that name, or one without `create`.
Provider providerByName(const std::string& name);

}  // namespace shadestep::doctor
