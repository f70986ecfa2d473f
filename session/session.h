// One program under debug, from launch to end: select a draw, look at its shaders, run capture passes.
// The debugger without a face: the command line and the window hold no debugging logic beyond this.
//
// Every function throws session::Error when it cannot do what it says; the program under debug is then still
// as it was. Not thread safe: one thread drives one Session; others may call interrupt() and kill() only.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "glsl-frontend/shader.h"
#include "instrumenter/instrumenter.h"
#include "session/calls.h"
#include "session/error.h"
#include "session/fragment_choice.h"
#include "session/thread_words.h"

namespace shadestep::wire {
struct PrepareT;
struct StageTextT;
class SharedMemory;
}  // namespace shadestep::wire

namespace shadestep::session {

using frontend::Stage;

const char* stageName(Stage);  // "fragment", "tess-control", ... as the command line spells them
std::optional<Stage> stageByName(const std::string&);

struct LaunchOptions {
  std::vector<std::string> command;       // program and arguments; found through PATH
  std::string interceptor;                // libshadestep-gl.so; empty: beside or above this executable
  bool program_output_to_stderr = false;  // keeps our own stdout clean for --json
  std::vector<std::pair<std::string, std::string>> environment;  // laid over our own
  std::string working_directory;                                 // of the program; empty: our own
  // Watch the program by ptrace, so that a crash is told with its thread; where that is not permitted it goes
  // without.
  bool ptrace = true;
  bool follow = true;               // debug processes that the program starts, too
  std::chrono::seconds timeout{0};  // for the program to reach what is asked for; 0 = no limit
};

// The path of libshadestep-gl.so: `given` if it exists, else the one beside or above this executable.
// Throws usage or failed if there is none.
std::string findInterceptor(const std::string& given = {});

// Where the program stands: in a draw call that it has not carried out yet.
struct DrawStop {
  std::uint64_t frame = 0;
  std::uint64_t draw = 0;
  std::string call;
  std::uint32_t mode = 0;   // GL primitive mode; 0xffffffff if none
  std::int64_t count = -1;  // vertices or indices per instance; -1 = not known on the CPU
  std::int64_t instances = 1;
};
// Whether the call is one draw of one instance, in which no two primitives have the same number.
bool drawsOnce(const DrawStop&);

// A thread by the numbers of its identity (ThreadValues::identity), with their names. Those left out are 0.
// Of threads that are told apart by coordinates (`u` and `v`), "vertex" says which of those with the same
// numbers otherwise. A fragment is named by its pixel, "x" and "y" (gl_FragCoord's origin, lower left).
using ThreadName = std::vector<std::pair<std::string, std::int32_t>>;
ThreadName pixelName(int x, int y);

struct StageFacts {
  Stage stage = Stage::fragment;
  std::vector<frontend::ShaderObject> objects;  // the shader objects that it is linked from
  std::string reason;                           // why it cannot be debugged; empty if it can
};

struct DrawFacts {
  std::string provider;  // "GLX", "EGL", "OSMesa"
  std::string version, renderer, vendor, glsl_version;
  bool es = false, core = false;
  int major = 0, minor = 0;
  std::vector<std::string> extensions;
  std::uint32_t program = 0;
  std::string program_reason;  // why there is no program to debug; empty if there is
  std::vector<StageFacts> stages;
  std::uint32_t framebuffer = 0;
  std::string target_reason;  // why this target cannot be captured; empty if it can
  int viewport[4] = {0, 0, 0, 0};
  int width = 0, height = 0;  // of the draw framebuffer
  int draw_buffers = 1, max_draw_buffers = 8, max_storage_blocks = 0;
  int layers = 0;   // of the draw framebuffer; 0 = not layered
  int samples = 0;  // 0 = not multisampled
  // Of the program: name, as glGetActiveUniform tells it, and elements. All others were dropped by the
  // driver, and with them what the program set.
  using Uniforms = std::map<std::string, int>;
  Uniforms active_uniforms;
  std::map<Stage, Uniforms> uniforms_elsewhere;  // of stages that a pipeline takes from other programs
  const Uniforms& uniformsOf(Stage) const;
  std::string replay_reason;    // why stages before rasterization cannot be replayed; empty if they can
  int feedback_components = 0;  // that transform feedback captures of a vertex; 0 = there is none
  bool draws_points = false;    // the call can be replayed as points
  int storage_blocks[6] = {};   // of each stage

  bool has(const std::string& extension) const;
};

// design point 9: the original outputs of an instrumented replay against the uninstrumented draw, bitwise.
struct Check {
  // Of the components that differ the one that differs most.
  struct Largest {
    double by = 0;  // at least 0; infinite where one of the two is not finite
    double expected = 0, got = 0;
    std::string where;  // "draw buffer 0"
  };
  bool compared_at_all = false;
  std::uint64_t compared = 0;  // components
  std::uint64_t differing = 0;
  std::optional<Largest> largest;  // none: nothing differs, or something that is not known to be numbers
  std::string reason;              // why not compared
  std::uint64_t undefined =
      0;  // components not counted above: the shader leaves them undefined (it writes no value)
  // Which threads of the draw the values do not cover, or which outputs are not compared ("" = none), for the
  // user.
  std::string left_out;
  std::string dropped;  // which uniforms the driver has no values of ("" = none), for the user
  bool identical() const { return compared_at_all && differing == 0; }
  // "identical", "differs", "not compared"
  void merge(const Check& other);  // the check of two passes together; a fresh one takes the other over
};

struct Uniform {
  std::string name;
  std::uint32_t gl_type = 0;         // GL_INT_VEC4, ...
  std::vector<std::uint32_t> words;  // as glUniform*v takes them
};

// A program prepared in the program under debug; released when it goes out of scope or the draw is left.
class Session;
class Prepared {
 public:
  Prepared() = default;
  Prepared(Session* session, std::uint32_t handle) : session_(session), handle_(handle) {}
  Prepared(Prepared&&) noexcept;
  Prepared& operator=(Prepared&&) noexcept;
  ~Prepared();
  std::uint32_t handle() const { return handle_; }
  std::chrono::nanoseconds compile_time{0};
  bool storage = false;  // it has a storage block of ours, which a buffer must always be bound to
  std::vector<int> output_locations;  // of the shader's declared outputs, as far as the program writes them
  std::string uncompared;  // what of the outputs a replay of it does not compare, and why ("" = nothing), for
                           // the user

 private:
  Session* session_ = nullptr;
  std::uint32_t handle_ = 0;
};

// Which vertex of a primitive its flat outputs come from; in the uninstrumented draw of the check, too.
enum class Provoking { keep, first, last };

struct ExecuteOptions {
  std::vector<Uniform> uniforms;
  std::vector<std::uint32_t> storage;  // first words of the storage buffer
  std::uint64_t storage_words = 0;     // its size; the rest is zero
  bool compare = true;
  bool read_outputs = false;
  bool read_captures = true;
  int repeats = 1;
  int covering_size = 64;  // with a Covering program
  // Not in replays of fragments: every repeat draws once per set, with these uniforms beside `uniforms`.
  std::vector<std::vector<Uniform>> sets;
  // With a Covering program: texture units that are read without filter and comparison (OpenGL 3.3, ES 3.0);
  // with `plain_levels`, which wants all levels to be there, at the levels asked for, else at the base level
  // alone.
  std::vector<int> plain_units;
  bool plain_levels = false;
  Provoking provoking = Provoking::keep;  // of fragment shaders; the driver has to let choose (OpenGL 3.2)
};

// One colour buffer after the draw, in the type that it holds: float, int or uint.
struct ColorOutput {
  int draw_buffer = 0;               // the location of the shader's output
  frontend::Type type;               // of a pixel: vec4, ivec4 or uvec4
  std::vector<std::uint32_t> words;  // width*height*4, rows bottom up
};

struct Execution {
  int width = 0, height = 0;
  std::vector<std::span<std::uint32_t>>
      attachments;  // each width*height*4 words, rows bottom up; in `memory`
  std::shared_ptr<const wire::SharedMemory> memory;
  std::vector<ColorOutput> outputs;  // the program's own
  std::span<std::uint32_t> storage;  // in `memory`
  // Records of `feedback_words`, in `memory`: what is captured, and with `read_outputs` the original outputs
  // behind it.
  std::span<std::uint32_t> feedback;
  int feedback_words = 0;
  // One per repeat (and set, the sets of a repeat in order), of draw + glFinish: on the CPU's clock, and as
  // CPU time of all threads of the program.
  std::vector<std::chrono::nanoseconds> times, cpu_times;
  Check check;
};

// What a sampler reads at a draw.
struct SamplerName {
  std::string uniform;       // "map", "maps[1]"
  std::uint32_t target = 0;  // GL_TEXTURE_2D, ...
};
struct SampledTexture {
  std::string uniform;
  std::string reason;  // why there is nothing to be read or told; empty if there is
  int unit = 0;
  std::uint32_t texture = 0;                                          // GL name
  std::uint32_t min_filter = 0, mag_filter = 0, wrap[3] = {0, 0, 0};  // GL enums
  float min_lod = -1000, max_lod = 1000, lod_bias = 0, anisotropy = 1;
  int base_level = 0;
  struct Size {
    int width = 1, height = 1, depth = 1;  // texels; depth: slices, layers or faces
  };
  std::vector<Size> levels;  // from the base level on, those that a lookup can read
  int samples = 0;           // 0 = not multisampled
};

// Memory that a draw reads or writes through a buffer.
enum class BufferUse { uniform_block, storage_block, atomic_counters, vertices, indices, commands, feedback };
// A member of a block, in bytes as the driver laid it out.
struct BlockMember {
  std::string name;          // "light.colour", "weights[0]", "items[0].place"
  std::uint32_t type = 0;    // GL_FLOAT_VEC3, ...
  std::uint64_t offset = 0;  // from where the block begins
  std::uint32_t count = 1;   // elements of an array; 0 = as many as there is room for
  std::uint32_t stride = 0;  // from one to the next
  std::uint32_t matrix_stride = 0;
  bool row_major = false;
  // Of the array of structures that it is in, of which its name is the first element's; 1 and 0 outside of
  // one.
  std::uint32_t outer_count = 1, outer_stride = 0;
};
struct BoundBuffer {
  BufferUse use = BufferUse::uniform_block;
  std::string name;                     // of the block or the vertex attribute
  int index = 0;                        // of the binding or the vertex attribute
  std::uint32_t buffer = 0;             // GL name; 0 = none
  std::uint64_t offset = 0, bytes = 0;  // what is bound of it
  std::string reason;                   // why there is nothing to read; empty if there is
  std::vector<BlockMember> members;     // of blocks and counters, by their offsets
  // Of vertices: how the attribute reads them, by GL's names.
  int components = 0;
  std::uint32_t type = 0;
  int stride = 0;
  bool normalized = false;
  int divisor = 0;
};

// Pixels of the draw's target, lower left corner and size.
struct Box {
  int x = 0, y = 0, width = 0, height = 0;
};
// Of a draw restricted to boxes: one of each per repeat and box, the boxes of a repeat in order, as
// Execution has them.
struct BoxTimes {
  std::vector<std::chrono::nanoseconds> times, cpu_times;
};

struct Captured {
  ThreadWords threads;
  instrumenter::AttachmentLayout layout;
  Execution execution;
};

// Why and where runUntil stopped.
struct Stop {
  StopReason reason = StopReason::ended;
  std::optional<CallStop> call;  // for all reasons but draw and ended
  std::optional<DrawStop> draw;  // for draw
  std::string end;               // for ended: how the program ended, and where
};

struct Progress {
  std::uint64_t frames = 0;
  std::uint64_t draws = 0;
};

class Session {
 public:
  explicit Session(const LaunchOptions&);  // launches and waits for the first sign of the interceptor
  ~Session();                              // ends the program if it still runs
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // Runs to the first draw at or after (frame, draw) that is in that very frame.
  // Throws nothing_matches if the frame has fewer draws, ended if the program stops before.
  DrawStop runTo(std::uint64_t frame, std::uint64_t draw);
  // Visits every draw of frames first..last; `visit` may describe and capture. Returns draws per frame.
  std::vector<std::uint64_t> forEachDraw(std::uint64_t first, std::uint64_t last,
                                         const std::function<void(const DrawStop&)>& visit);
  // Visits the GL, GLX, EGL and OSMesa calls of the frames, and runs to the end of the last one, or of the
  // program. Throws ended if the program stops before the first of these frames.
  void forEachCall(const CallFilter&, const CallVisitor& visit);

  // ---- stopping at calls ----
  // Runs on until one of the conditions holds, interrupt() was called, or the program ended. Blocks
  // meanwhile; the visitor of tellCalls is called from within. At a draw everything below works; at a call
  // only setArgument, skipCall, and running on.
  Stop runUntil(const StopCondition&);
  // From now on runUntil tells of these calls, in batches: all of them before it returns. No visitor: of
  // none.
  void tellCalls(const CallFilter&, CallVisitor visit);
  // Changes an argument of the call at which the program stands, for this one time; returns how the call
  // shows it now. The value is spelt as LoggedCall shows it: 7, 0.5, GL_LINES, GL_COLOR_BUFFER_BIT | 0x100,
  // GL_TRUE, "text", {1, 0, 0, 1} (as many elements as there are), NULL or 0x... for other pointers. Throws
  // nothing_matches if there is no such argument or it does not fit; failed where the program does not stand
  // before a call.
  std::string setArgument(const std::string& name, const std::string& value);
  // The call at which the program stands will not be made; the program is told 0. Throws as setArgument.
  void skipCall();
  // The call at which the program stands; null where it does not.
  const CallStop* callStop() const;
  // Thread safe. Stops the program at its next call: runUntil returns `interrupted`; runTo, forEachDraw,
  // forEachCall and runToEnd throw Interrupted. Asked for while nothing runs, it holds for the next run. A
  // program that makes no calls does not stop: kill() is what then helps.
  void interrupt() noexcept;
  // Thread safe. Ends the program under debug at once; what runs sees it end.
  void kill() noexcept;

  // Runs on to the program's own end, returns its exit status as a shell gives it (128 + signal).
  int runToEnd();
  // Ends the program now.
  void quit();
  // Frames ended and draws begun so far, over the whole run.
  Progress progress();
  // The process that was launched. May be asked on any thread: a signal to it ends a wait of the others'.
  int processId() const;

  const DrawStop& stop() const;
  const DrawFacts& facts();  // of the current stop; asked once
  // The analysed shader of a stage. Throws cannot_debug with the reason, nothing_matches if there is no such
  // stage.
  const frontend::Shader& shader(Stage);

  // The stage that is looked at, at this and later stops: shader(), target() and all capture passes are about
  // it.
  void select(Stage);
  Stage stage() const;
  const frontend::Shader& shader() { return shader(stage()); }
  instrumenter::Target target();  // what the driver offers to instrumented shaders of this stage

  // All state of the program's context that can be asked for: names and values, always in the same order.
  // What OpenGL gives as integers and as floats is there once, as what says more.
  std::vector<std::pair<std::string, std::string>> glState();

  // In the order of the names.
  std::vector<SampledTexture> textures(const std::vector<SamplerName>&);
  // Blocks, vertex attributes and other buffers of the draw. What stands in them is as before the draw.
  std::vector<BoundBuffer> buffers();
  // Throws cannot_debug where the buffer is not that large, or the program has mapped it.
  std::vector<std::byte> readBuffer(std::uint32_t buffer, std::uint64_t offset, std::uint64_t bytes);

  // Throws cannot_debug, with the reason, if captures of the selected stage cannot work at this draw.
  void requireCapturable();

  // ---- capture passes at the current stop ----
  // Holds for all executions from here on, at later stops too. Throws nothing_matches if the current draw's
  // target has no such layer or sample, cannot_debug if its context has no such test.
  void choose(const FragmentChoice&);
  Prepared prepare(const instrumenter::AttachmentShader&);
  // Of a fragment shader, with another text of an earlier stage beside it.
  Prepared prepare(const instrumenter::AttachmentShader&, Stage beside, const std::string& text);
  Prepared prepare(const instrumenter::RecordingShader&);
  Prepared prepareOriginal();                     // the program's own text
  Prepared prepareText(const std::string& text);  // another text with the same outputs, without captures
  // Another text with the same outputs, which writes the storage block of this name.
  Prepared prepareStorage(const std::string& text, const std::string& block);
  Prepared prepareCovering(const std::string& fragment_text, const std::string& vertex_text);  // isolate
  Execution execute(const Prepared&, const ExecuteOptions& = {});
  // Times the program's own draw, with its own program or none, restricted to each of the boxes, which do not
  // overlap; works where there is no shader to debug. Throws cannot_debug if this target cannot be drawn
  // again.
  BoxTimes timeBoxes(const std::vector<Box>&, int repeats);
  // prepare + execute. Threads that end in a discard are put where the draw
  // shows none of its fragments, marked kDiscarded: the nearest of them; where that is not clear, none, and
  // `left_out` says so.
  Captured capture(const instrumenter::AttachmentShader&, const ExecuteOptions& = {});
  // The same with a program that is there already, read by its layout or by that of one of its probes.
  Captured capture(const Prepared&, const instrumenter::AttachmentLayout&, const ExecuteOptions& = {});
  // Executes a fragment shader whose layout, that of `captured`, has a list, with room for all that it lists;
  // the result points into `captured`.
  instrumenter::DiscardedThreads captureListed(const Prepared&, ExecuteOptions, Captured& captured);
  struct PreparedRecording {
    instrumenter::RecordingShader shader;
    Prepared program;
  };
  PreparedRecording prepareRecording();
  // All threads of a rectangle of pixels (lower left corner, size), with as much room as they need.
  struct Recorded {
    instrumenter::Recording recording;
    instrumenter::RecordingLayout layout;
    Execution execution;
    ThreadWords visible;  // of execution's attachment: mark, invocation
  };
  Recorded record(const PreparedRecording&, int x, int y, int width, int height);
  Recorded record(int x, int y, int width, int height);  // prepares it first
  // One thread of another stage, by its identity. Its layout has no attachment.
  Recorded record(const PreparedRecording&, const std::vector<std::int32_t>& identity);

  void release(std::uint32_t handle) noexcept;  // by ~Prepared

 private:
  Prepared send(wire::PrepareT&&);
  Prepared sendFragments(const instrumenter::AttachmentShader&, std::unique_ptr<wire::StageTextT> beside);
  Captured captureThreads(const Prepared&, const instrumenter::AttachmentLayout&, const ExecuteOptions&);
  Prepared prepareStages(const std::string& text, const instrumenter::AttachmentLayout&);
  Recorded recordWith(const PreparedRecording&, const std::vector<std::uint32_t>& which,
                      std::uint64_t threads, std::uint64_t room);
  void leaveOutUndefined(const Prepared&, const ExecuteOptions&, std::uint64_t unstable, Check&);
  struct State;
  std::unique_ptr<State> state_;
};

// Does gl_FragCoord count rows from the top (layout(origin_upper_left))?
bool countsRowsFromTop(const frontend::Shader&);

// The first `words` of each thread in the attachments.
ThreadWords threadWords(const Execution&, int words);

}  // namespace shadestep::session
