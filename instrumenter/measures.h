// What whole threads of a fragment shader do and cost: loops, counts, texture lookups, clock ticks, and one
// thread's work by itself. Text to text, as instrumenter.h.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "instrumenter/instrumenter.h"

namespace shadestep::instrumenter {

// Per loop of the shader four uint fields: "entries" (times entered), "iterations" (bodies begun, all
// entries together), "longest" (bodies begun in the longest entry), "cut" (entries that ended although
// neither the condition nor a jump ended them). Fields are named "<statement id>.entries", ...
Result<AttachmentShader> instrumentLoops(const frontend::Shader&,
                                         const std::vector<frontend::StatementId>& loops, const Target&);

// A texture lookup in the shader's text: a call of a built-in whose first argument is a sampler.
struct TextureFetch {
  frontend::TokenIndex name = frontend::kNone;      // "texture", "texelFetch", ...
  frontend::TokenIndex close = frontend::kNone;     // the closing parenthesis
  std::string function;                             // the name's text
  std::string sampler;                              // the first argument as written: "volume", "maps[i]"
  frontend::VariableId variable = frontend::kNone;  // the sampler: a uniform, or a parameter
  std::vector<frontend::TokenRange> arguments;
};
std::vector<TextureFetch> textureFetches(const frontend::Shader&);

// Something that a thread does, to be counted.
struct Counted {
  enum class Kind {
    runs,     // of a statement, or evaluations of its condition (no block, no case label)
    taken,    // evaluations of the condition of an if or a loop that came out true
    entered,  // of a function
    fetched,  // of a texture lookup: index into textureFetches
  };
  Kind kind = Kind::runs;
  int id = 0;  // StatementId, FunctionId or index
  auto operator<=>(const Counted&) const = default;
};
std::string nameOf(const Counted&);  // "runs.12": the name of its field

// One uint field for each, in order. None asked for: one field "steps", statements executed and conditions
// evaluated (loops: each time). Ask in batches that fit the draw buffers.
Result<AttachmentShader> instrumentCount(const frontend::Shader&, const std::vector<Counted>&, const Target&);

// The clock that shaders can read: GL_ARB_shader_clock, or GL_EXT_shader_realtime_clock where that is
// missing.
struct ShaderClock {
  std::string extension, function;  // the function: uvec2 of the low and the high word
};
std::optional<ShaderClock> shaderClock(const Target&);

// Uint fields "low", "high": ticks of the shader clock from start to end of the thread modulo 2^64, and
// "start_high": the upper word of the reading at the start (0 below GLSL 1.30).
Result<AttachmentShader> instrumentClock(const frontend::Shader&, const Target&);

// Threads of this stage that do known work instead of the shader's own, which they leave out: a chain of as
// many dependent steps as the int uniform `work_uniform` says; `clocked`: between two readings, with the
// fields of instrumentClock first. A control shader's threads do their own work after it.
struct KnownWork {
  AttachmentShader shader;
  std::string work_uniform;
};
Result<KnownWork> instrumentKnownWork(const frontend::Shader&, const Target&, bool clocked);

// Every input of a fragment, a vertex or an invocation becomes a variable that the new main sets from
// uniforms (thesis 7.2.1).
struct IsolatedInput {
  std::string input;  // "texcoord" or "gl_FragCoord", the watch to capture it by
  frontend::Type type;
  int first_word = 0;  // of `wordCount(type)` words in the uniform
};
enum class Isolation {
  plain,  // every fragment does what one thread did
  quad,   // every 2 x 2 quad of fragments does what the four threads of one quad did: derivatives and levels
          // of detail are the true ones
};
struct IsolatedShader {
  std::string text;           // the user's shader with inputs replaced; nothing is captured
  std::string baseline_text;  // same outputs, empty main: what the draw costs without the shader
  // Of fragments only, as what follows (of other stages see instrumentKnownWork).
  // Same outputs, and a chain of as many dependent steps as the int uniform `work_uniform` says: known work,
  // to test timers with and to notice that the machine drifts.
  std::string work_text;
  std::string work_uniform;
  std::string vertex_text;  // a vertex shader for one triangle that covers the target, from gl_VertexID or,
                            // below GLSL 1.30, from its only attribute: (-1,-1), (3,-1), (-1,3)
  std::vector<IsolatedInput> inputs;
  // An array of uvec4 (vec4 where `floats`): vectors_per_thread for the one thread, or for each of the four
  // of a quad in the order (0,0), (1,0), (0,1), (1,1) of their coordinates' parity. "" without inputs.
  std::string words_uniform;
  int vectors_per_thread = 0;
  bool floats = false;
};
Result<IsolatedShader> instrumentIsolate(const frontend::Shader&, const Target&,
                                         Isolation = Isolation::plain);

// Does a fragment ask for its inputs at another place, so that it can be isolated in its quad only?
bool readsInputsElsewhere(const frontend::Shader&);

// A probe at the start of main that watches the inputs which instrumentIsolate replaces (none, if that
// fails).
Probe inputsProbe(const frontend::Shader&);

}  // namespace shadestep::instrumenter
