// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/replay/outputs.h"

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"

namespace shadestep::replay {
namespace {

using dispatch::gl;
using guard::OrRefusal;
using guard::Refusal;

// gl_FragData[n], whose place is its index.
bool builtIn(const wire::PrepareT& request, const wire::CaptureOutputT& output) {
  return request.first_frag_data >= 0 || output.name.empty();
}

Refusal checkPlace(const guard::ContextFacts& facts, const std::set<int>& taken, int location,
                   std::size_t captures) {
  if (taken.count(location) != 0) {
    return guard::limit("output location " + std::to_string(location) +
                        " is taken by the program's own outputs and buffers");
  }
  if (location < facts.max_draw_buffers) return {};
  return guard::limit(
      std::to_string(captures) + " capture buffers beside the program's own are more than the " +
      std::to_string(facts.max_draw_buffers) + " draw buffers of this driver (GL_MAX_DRAW_BUFFERS); capture less at once");
}

}  // namespace

UserOutputs bindUserOutputs(GLuint original, GLuint copy, const std::vector<std::string>& outputs, int most) {
  UserOutputs result;
  const bool indexed =
      dispatch::available("glGetFragDataIndex") && dispatch::available("glBindFragDataLocationIndexed");
  for (const std::string& name : outputs) {
    const GLint location = gl().GetFragDataLocation(original, name.c_str());
    if (location < 0) continue;  // not written by the original
    const GLint index = indexed ? gl().GetFragDataIndex(original, name.c_str()) : 0;
    if (index > 0) {
      gl().BindFragDataLocationIndexed(copy, static_cast<GLuint>(location), static_cast<GLuint>(index),
                                       name.c_str());
      result.second_sources.insert(location + 1);
      continue;
    }
    if (dispatch::available("glBindFragDataLocation")) {
      gl().BindFragDataLocation(copy, static_cast<GLuint>(location), name.c_str());
    }
    result.locations.insert(location);
    for (int i = 1; i < most; ++i) {  // an array's other elements
      const GLint element =
          gl().GetFragDataLocation(original, (name + "[" + std::to_string(i) + "]").c_str());
      if (element < 0) break;
      result.locations.insert(element);
    }
  }
  guard::clearErrors();
  return result;
}

OrRefusal<std::vector<capture::CaptureBuffer>> bindCaptures(const guard::ContextFacts& facts,
                                                            const capture::DrawTarget& target,
                                                            const wire::PrepareT& request, GLuint copy,
                                                            std::set<int> taken) {
  std::vector<capture::CaptureBuffer> placed;
  const bool binds = dispatch::available("glBindFragDataLocation");
  for (const auto& color : target.colors) taken.insert(color.draw_buffer);
  int next = 0;
  for (std::size_t i = 0; i < request.captures.size(); ++i) {
    const wire::CaptureOutputT& output = *request.captures[i];
    if (builtIn(request, output)) {
      next = request.first_frag_data + static_cast<int>(i);
    } else {
      while (taken.count(next) != 0) ++next;
    }
    if (Refusal refusal = checkPlace(facts, taken, next, request.captures.size()); !refusal.text.empty())
      return refusal;
    taken.insert(next);
    placed.push_back({next, output.format});
    if (binds && !builtIn(request, output)) {
      gl().BindFragDataLocation(copy, static_cast<GLuint>(next), output.name.c_str());
    }
  }
  return placed;
}

Refusal confirmCaptures(const guard::ContextFacts& facts, const capture::DrawTarget& target,
                        const wire::PrepareT& request, GLuint copy,
                        std::vector<capture::CaptureBuffer>& captures) {
  std::set<int> taken;
  for (const auto& color : target.colors) taken.insert(color.draw_buffer);
  for (std::size_t i = 0; i < captures.size(); ++i) {
    const wire::CaptureOutputT& output = *request.captures[i];
    if (!builtIn(request, output)) {
      const GLint location = gl().GetFragDataLocation(copy, output.name.c_str());
      if (location >= 0) {
        captures[i].location = location;
      } else if (i == 0) {
        return {wire::ErrorKind::Link, "the linked program has no output " + output.name + " to capture"};
      } else {
        // Every word of this output is a value that the shader never defines, and the linker dropped it. The
        // first output holds the mark, which is always defined.
        while (taken.count(captures[i].location) != 0) ++captures[i].location;
      }
    }
    Refusal refusal = checkPlace(facts, taken, captures[i].location, captures.size());
    if (!refusal.text.empty()) return refusal;
    taken.insert(captures[i].location);
  }
  return {};
}

}  // namespace shadestep::replay
