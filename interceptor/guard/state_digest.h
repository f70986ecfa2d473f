// All of the current context's state that can be asked for, as text: taken twice, it shows what was not put
// back. What to ask stands in the registry's own groups of constants, so nothing is forgotten by hand. Runs
// inside the program under debug: throws nothing, starts no thread, calls GL only through dispatch::gl().
#pragma once

#include <string>
#include <vector>

#include "interceptor/guard/context_facts.h"

namespace shadestep::guard {

struct StateValue {
  std::string name;   // "GL_BLEND", "texture unit 3 GL_TEXTURE_BINDING_2D", "uniform color"
  std::string value;  // integers and floats as the driver gives them
};

// Values that change by themselves (the time, free memory) are left out. Contents of buffers and textures are
// not looked at.
std::vector<StateValue> stateDigest(const ContextFacts&);

}  // namespace shadestep::guard
