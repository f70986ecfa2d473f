// Probes on an analysed shader -> the text of an instrumented shader, and the layout of the words it
// captures. Plain functions from text to text: no OpenGL here. Method: Strengert 2010, 7.1.4.
//
// In every instrumented text the user's own tokens stand unchanged and in order, with insertions; the only
// replacements are the name of `main` (wrapped, so that captured words are written at every end of the
// thread; constructs/main.h), the names of functions cloned along a call path, `discard`
// (constructs/discard.h), gl_FragColor (constructs/fragment_outputs.h), and EmitVertex and EndPrimitive where
// emits are listed (emits.cpp).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "glsl-frontend/shader.h"

namespace shadestep::instrumenter {

// How captured words leave the shader.
enum class Carrier {
  uint_attachments,   // uvec4 outputs, bit for bit (GLSL >= 1.30 / ES 3.00)
  float_attachments,  // vec4 outputs via gl_FragData (GLSL < 1.30): floats as they are, integers as 16-bit
                      // halves
  uint_feedback,      // uvec4 outputs of a stage before rasterization, bit for bit, for transform feedback
  float_feedback,     // vec4 outputs (GLSL < 1.30), as with float_attachments
  list,               // appended to a storage block, thread by thread, bit for bit
};

// What the driver offers; the session fills it in from the agent's answer.
struct Target {
  bool storage_buffers = false;  // GL_ARB_shader_storage_buffer_object usable in this stage
  bool bit_encoding = false;     // floatBitsToInt available or enabled by GL_ARB_shader_bit_encoding
  bool shader_clock = false;     // GL_ARB_shader_clock
  bool realtime_clock = false;   // GL_EXT_shader_realtime_clock
  bool query_lod = false;        // GL_ARB_texture_query_lod
  bool es_draw_buffers = false;  // GL_EXT_draw_buffers: several outputs in GLSL ES 1.00
  int max_draw_buffers = 8;
  int used_draw_buffers = 1;  // colour outputs that the program's own framebuffer uses
  // That transform feedback of this stage's last words has room for beside the original outputs; of a
  // geometry shader without them. 0: there is none.
  int feedback_components = 0;
  bool gpu_shader4 = false;     // GL_EXT_gpu_shader4: gl_VertexID and gl_InstanceID below GLSL 1.30
  bool draw_instanced = false;  // GL_ARB_draw_instanced: gl_InstanceIDARB
};

// One captured scalar component in a block of words.
// uint_attachments, uint_feedback and list: `words` = 1 (2 for 64-bit types, low word first).
// float_attachments and float_feedback: float takes 1 channel; int, uint, bool take 2 (low 16 bits, high 16
// bits, each as a float).
struct Field {
  std::string name;  // the watched expression or variable
  frontend::Type type;
  int first_word = 0;  // index into the thread's or record's words
};

// Words per thread, in attachments of 4 channels each. Word 0 is the *mark*: 0 = no fragment of the draw is
// visible here; kLaunched = the thread ran; kLaunched | kReached = it got to the probe. kDiscarded is no
// shader's doing: it marks words that come from the list of discarded threads.
inline constexpr std::uint32_t kLaunched = 1;
inline constexpr std::uint32_t kReached = 2;
inline constexpr std::uint32_t kDiscarded = 4;

// A thread that ends in a discard leaves nothing in attachments. Where the driver has storage buffers it
// appends its words to a list in a block instead:
//   [0] number of such threads (atomic), 0 before the draw   [1] number of those that there is room for
//   [2],[3] reserved; all four are ints then per thread, in order of their ends, `discarded_words` words of
//   the carrier: gl_FragCoord.x, .y (floor; in the shader's own convention), .z, 1, and what it would have
//   left in its attachments
//
// Threads of other stages than the fragment stage have no place in a picture: their words come with what
// tells who they are (identityOf), `identity` values before those asked for. With Carrier::list the block is
//   [0] number of threads (atomic), 0 before the draw   [1] number of those that there is room for   [2],[3]
//   reserved then per thread, in order of their ends, `words` rounded up to a multiple of four
struct AttachmentLayout {
  Carrier carrier = Carrier::uint_attachments;
  int words = 1;                // including the mark
  std::vector<Field> identity;  // who the thread is; empty for fragments, and where the dialect does not tell
  std::vector<Field> fields;
  std::vector<std::string> outputs;  // names of the capture outputs, in order; empty with gl_FragData, where
                                     // capture outputs are gl_FragData[first_frag_data ...]
  int first_frag_data = 0;
  std::string discarded_block;  // name of the storage block; empty: discarded threads are not captured
  int discarded_words = 0;      // per thread in the list
  std::string list_block;       // Carrier::list: name of the storage block
  int attachments() const { return (words + 3) / 4; }
};

// What one record in a recording says.
enum class Event {
  function_enter,  // values: parameters that come in
  function_leave,  // fell off the end; values: out parameters
  before,          // about to run a statement that calls user functions, or any loop
  statement,  // ran it; values: what it may have changed (in scope), declared variables. Of large arrays, of
              // memory that all threads see and of images, the part written, named as the user wrote it
  condition,  // evaluated it; first value is the outcome "" (bool; int/uint for switch; true for a missing
              // one), then what changed. for: with what init (its variables too) or increment changed
  iteration,  // at the start of a loop's body
  return_,    // about to return; first value is the returned one, named "return", if any
  jump,       // about to break, continue or discard
  call,       // about to evaluate the arguments of `call` and then to enter its function; where the order of
              // records does not tell which call it is. Calls nest: the last one not yet entered is entered
  choice,  // evaluated the operand that decides at the operator `token` (?:, && or ||): its value, named ""
  declarator,  // the declarator at `token` and those before it have run, the next is about to: what changed
};
struct RecordLayout {
  Event event = Event::statement;
  frontend::StatementId statement = frontend::kNone;
  frontend::FunctionId function = frontend::kNone;
  frontend::CallId call = frontend::kNone;
  frontend::TokenIndex token = frontend::kNone;  // call: the function's name
  std::vector<Field> fields;                     // first_word counts from after the record's id
  int words = 0;                                 // without the id
  std::vector<std::string> left_out;             // what changed, too, but is wider than kWidestRecorded
};

// Recording: the storage block is an array of 32-bit ints:
//   [0] number of threads that started (atomic); the program's session clears it before the draw
//   [1] words available per thread, written by the session before the draw
//   [2] number of threads that there is room for, written by the session
//   [3] reserved
//   then per thread (in order of start) `words available` ints:
//     [0] words that the thread wanted, these four included (may exceed what fits: then run again with more
//     room) [1],[2] gl_FragCoord.x, .y as integers (floor; in the shader's own convention, should it say
//     origin_upper_left)   [3] mark of this invocation: 1 = ran to its end, 2 = ended in a discard, 0 =
//     neither seen [4...] records: id (1-based index into `records`), then its words
// The same invocation number (its order of start + 1) is written to attachment output 0, so that the visible
// fragment among several on one pixel is known.
inline constexpr int kRecordingHeader = 4;
inline constexpr int kThreadHeader = 4;
// Values of more words than this (large arrays) are left out of records, which name them.
inline constexpr int kWidestRecorded = 64;
// Other stages: [1],[2] are the first two numbers of the thread's identity, and there is no attachment.
struct RecordingLayout {
  std::string block;          // name of the storage block
  std::string pixel_uniform;  // ivec4: x, y (lower left) and width, height of the recorded pixels; of other
                              // stages the numbers of identityOf, of the one recorded thread
  std::vector<RecordLayout> records;  // record id - 1 -> layout
  AttachmentLayout attachment;        // the mark, then the invocation number (field "invocation", uint)
};

struct Failure {
  std::string reason;
};  // one sentence for the user

struct AttachmentShader {
  std::string text;
  AttachmentLayout layout;
};
struct RecordingShader {
  std::string text;
  RecordingLayout layout;
};
template <class T>
using Result = std::variant<T, Failure>;

// What tells the threads of a stage apart: a number each ("vertex", "instance"), and how the shader calls it.
// Empty for fragments, and where the dialect has no such names. Threads of several instances, or of the draws
// of a multi-draw, may have the same numbers.
struct Identity {
  std::string name;
  std::string expression;
  std::string extension;                          // that it needs; "" = none
  frontend::Basic basic = frontend::Basic::int_;  // or float_
};
std::vector<Identity> identityOf(const frontend::Shader&, const Target&);

// The outputs that a stage before rasterization writes, built-in ones too.
std::vector<frontend::VariableId> stageOutputs(const frontend::Shader&);

// The same, as transform feedback names them.
struct FeedbackOutput {
  std::string name;  // "gl_Position", "Block.member", "light[2].colour"
  frontend::Type type;
};
std::vector<FeedbackOutput> feedbackOutputs(const frontend::Shader&);

// ---- emits: what a geometry shader makes of each input primitive
// ------------------------------------------------------------------------------------------------------

// All vertices that all threads emit, with what the shader gives them. The threads of the list, by their
// marks: kLaunched | kReached = an emitted vertex, kLaunched = a thread has ended. Fields: those of
// EmitField, then the shader's outputs.
struct EmitsShader {
  std::string text;
  AttachmentLayout layout;
  std::vector<std::string> left_out;  // outputs that there is no room for
};
// The first fields, each an int. `thread` tells threads of the same identity apart: their order of start.
// `stream`, `strip` (how often the thread ended a primitive of the stream before) are 0 where a thread ends;
// `vertices`: how many it emitted before, or in all. By transform feedback `thread` is 0: there the threads
// lie one behind the other, each with its end, and what it emits beyond max_vertices is not listed.
enum EmitField { kEmitThread, kEmitStream, kEmitStrip, kEmitVertices, kEmitFields };
Result<EmitsShader> instrumentEmits(const frontend::Shader&, const Target&);

// Of the declaration `layout(triangle_strip, max_vertices = 15) out;`: "points", "line_strip" or
// "triangle_strip"; -1 where the number is no literal.
struct EmitLimits {
  std::string primitive;
  int max_vertices = -1;
};
EmitLimits emitLimits(const frontend::Shader&);

// ---- single: one probe, all threads
// ------------------------------------------------------------------------

// A place in the run of a thread at which values are looked at.
struct Probe {
  enum class When { before, after } when = When::before;
  // after: after the statement ran (expression, declaration), or after a condition was evaluated,
  // for all threads that evaluate it (thesis: buffered condition); after the init of a `for`: before the
  // first evaluation of its condition
  frontend::StatementId statement = frontend::kNone;  // `before` the body block of a function = at its start
  std::vector<frontend::CallId> call_path;  // from main inwards; empty = any call (no function is cloned)
  std::vector<int> iterations;              // 0-based, per enclosing loop of the whole call path, outermost
                                // first; may be shorter; loops without a number: the last time wins.
                                // A loop's body i and the evaluation i of its condition have number i
                                // (`after` on a loop: its own number comes last). With an empty call
                                // path: the loops of the statement's function
  std::vector<frontend::Watch> watches;
  bool outcome = false;  // with When::after on a condition: also capture its outcome ("")
  // With When::after: not after the whole statement, but inside of its own expressions. At an operator ?:, &&
  // or || (choicesOf): right after the operand that decides, whose value is the outcome. At the closing
  // parenthesis of a call of a user function: right after it returned.
  frontend::TokenIndex inside = frontend::kNone;
};

// The operators ?:, && and || in a statement's own expressions, a loop's increment included; outer ones
// before those inside of them. Those that literals decide are left out.
std::vector<frontend::TokenIndex> choicesOf(const frontend::Shader&, frontend::StatementId);

// The loops whose iterations `Probe::iterations` numbers, for a probe at this place: those around each call
// of the path (also one that calls from its own condition or increment), then those around the statement.
std::vector<frontend::StatementId> numberedLoops(const frontend::Shader&, const Probe&);

// One probe whose words leave through attachments. `first` .. as many watches as fit are taken when
// there are more than the draw buffers hold: `layout.fields` says which; ask again with the rest.
Result<AttachmentShader> instrumentSingle(const frontend::Shader&, const Probe&, const Target&);

// ---- window: several probes, one text
// ----------------------------------------------------------------------

// The probes of one text are chosen by a uniform, and the iterations that each means are uniforms too:
// another step, or another iteration, costs a draw and no compilation. The words of all probes lie over each
// other.
struct WindowLayout {
  AttachmentLayout capture;  // of the text: carrier, outputs, words of the widest probe; no fields
  std::vector<AttachmentLayout> probes;  // as `capture`, with the words and the fields of each probe
  std::string probe_uniform;             // int: index of the probe; one that is not there captures nothing
  // int each: Probe::iterations[i] of the chosen probe. Those beyond its own count for nothing.
  std::vector<std::string> iteration_uniforms;
};
struct WindowShader {
  std::string text;
  WindowLayout layout;
};

// How many iterations each probe has says how many of its loops are numbered; their values do not matter
// here. Fails if the words of one probe do not fit: make its watches fewer. Fails also if a probe that takes
// any call of a function meets one that tells the calls of this function apart: one text cannot hold both.
Result<WindowShader> instrumentWindow(const frontend::Shader&, const std::vector<Probe>&, const Target&);

// ---- recording: every step of chosen threads
// ---------------------------------------------------------------

Result<RecordingShader> instrumentRecording(const frontend::Shader&, const Target&);

// The user's shader with every output set before main (of a fragment shader its colours), to so many
// quarters, integers to that number. Where what it leaves depends on that, it leaves an output undefined.
// Nothing else is changed and nothing captured.
Result<std::string> instrumentFilledOutputs(const frontend::Shader&, const Target&, int quarters);

// The user's tokens, emitted with nothing inserted: the round trip.
std::string uninstrumented(const frontend::Shader&);

// ---- decoding
// ----------------------------------------------------------------------------------------------

// A decoded value: its type and its words in canonical order (frontend::components), bit for bit.
struct Value {
  frontend::Type type;
  std::vector<std::uint32_t> words;
  bool operator==(const Value&) const = default;
};

// `words`: the thread's words (layout.words of them), as read from the attachments (float attachments: the
// floats' bits).
Value decode(const AttachmentLayout&, const Field&, const std::uint32_t* words);
// The same for many threads: what is to be known of the field is asked for once.
class FieldDecoder {
 public:
  FieldDecoder(const AttachmentLayout&, const Field&);
  std::size_t words() const { return words_; }  // of the value: frontend::wordCount
  // `thread`: its words. Writes words() words to `out`.
  void decode(const std::uint32_t* thread, std::uint32_t* out) const;
  // The same of `count` threads, whose words are `stride` apart.
  void decode(const std::uint32_t* threads, std::size_t stride, std::size_t count, std::uint32_t* out) const;

 private:
  std::size_t first_, words_;
  bool floats_;
  std::vector<frontend::Component> components_;
};
// The mark word of a thread under any carrier.
std::uint32_t decodeMark(const AttachmentLayout&, const std::uint32_t* words);
std::uint32_t encodeMark(const AttachmentLayout&, std::uint32_t mark);

// The threads that ended in a discard, as they stand in the storage block.
inline constexpr int kDiscardedHeader = 4;
struct DiscardedThread {
  int x = 0, y = 0;
  float depth = 0;                       // gl_FragCoord.z
  const std::uint32_t* words = nullptr;  // layout.words of them, inside of the decoded block
};
struct DiscardedThreads {
  std::uint32_t ended = 0;  // more than `threads` if there was not enough room
  std::vector<DiscardedThread> threads;
};
DiscardedThreads decodeDiscarded(const AttachmentLayout&, std::span<const std::uint32_t> block);

struct Record {
  int layout = 0;             // index into RecordingLayout::records
  std::vector<Value> values;  // one per field of that layout
};
struct ThreadRecording {
  int x = 0, y = 0;
  std::uint32_t invocation = 0;  // order of start + 1
  bool discarded = false;
  bool complete = false;  // false: not enough room; `wanted` says how many words were needed
  std::uint32_t wanted = 0;
  std::vector<Record> records;
};
struct Recording {
  std::uint32_t started = 0;  // threads on the recorded pixels
  std::vector<ThreadRecording> threads;
  std::string error;  // a stream that does not decode is an error, never half a result
};
Recording decodeRecording(const RecordingLayout&, std::span<const std::uint32_t> words);

}  // namespace shadestep::instrumenter
