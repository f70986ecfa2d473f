// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/agent/describe_buffers.h"

#include <algorithm>
#include <array>
#include <set>

#include "interceptor/agent/executed.h"
#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/buffer_bytes.h"
#include "interceptor/guard/errors.h"

namespace shadestep::agent {
namespace {

using dispatch::gl;
using Bound = std::unique_ptr<wire::BoundBufferT>;

GLint integer(GLenum name) {
  GLint value = 0;
  gl().GetIntegerv(name, &value);
  return guard::clearErrors() ? 0 : value;
}

GLint64 indexed(GLenum name, GLuint index) {
  GLint64 value = 0;
  gl().GetInteger64i_v(name, index, &value);
  return guard::clearErrors() ? 0 : value;
}

bool copies() {
  return dispatch::available("glCopyBufferSubData") && dispatch::available("glMapBufferRange");
}

// `size` 0: from the offset to the buffer's end.
void setRange(wire::BoundBufferT& bound, GLuint buffer, GLint64 offset, GLint64 size) {
  bound.buffer = buffer;
  if (buffer == 0) {
    bound.reason = "no buffer is bound there";
    return;
  }
  const GLint64 there = std::max<GLint64>(guard::bufferSize(buffer) - offset, 0);
  bound.offset = static_cast<std::uint64_t>(offset);
  bound.bytes = static_cast<std::uint64_t>(size > 0 ? std::min(size, there) : there);
  if (bound.bytes == 0) bound.reason = "the buffer holds nothing there";
}

// A kind of binding points that a program's blocks are read through.
struct BlockKind {
  wire::BufferUse use;
  GLenum blocks, variables;     // program interfaces
  GLenum binding, start, size;  // of the context
};
constexpr std::array kBlockKinds = {
    BlockKind{wire::BufferUse::UniformBlock, GL_UNIFORM_BLOCK, GL_UNIFORM, GL_UNIFORM_BUFFER_BINDING,
              GL_UNIFORM_BUFFER_START, GL_UNIFORM_BUFFER_SIZE},
    BlockKind{wire::BufferUse::StorageBlock, GL_SHADER_STORAGE_BLOCK, GL_BUFFER_VARIABLE,
              GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START,
              GL_SHADER_STORAGE_BUFFER_SIZE},
    BlockKind{wire::BufferUse::AtomicCounters, GL_ATOMIC_COUNTER_BUFFER, GL_UNIFORM,
              GL_ATOMIC_COUNTER_BUFFER_BINDING, GL_ATOMIC_COUNTER_BUFFER_START,
              GL_ATOMIC_COUNTER_BUFFER_SIZE},
};

GLint resource(GLuint program, GLenum interface, GLuint index, GLenum property) {
  GLint value = 0;
  gl().GetProgramResourceiv(program, interface, index, 1, &property, 1, nullptr, &value);
  return guard::clearErrors() ? 0 : value;
}

std::string resourceName(GLuint program, GLenum interface, GLuint index) {
  const GLint length = resource(program, interface, index, GL_NAME_LENGTH);
  if (length <= 0) return {};
  std::string name(static_cast<std::size_t>(length), '\0');
  gl().GetProgramResourceName(program, interface, index, length, nullptr, name.data());
  name.resize(name.find('\0') == std::string::npos ? name.size() : name.find('\0'));
  return guard::clearErrors() ? std::string() : name;
}

std::unique_ptr<wire::BlockMemberT> memberAt(GLuint program, const BlockKind& kind, GLuint variable) {
  const auto ask = [&](GLenum property) {
    return static_cast<std::uint32_t>(resource(program, kind.variables, variable, property));
  };
  auto member = std::make_unique<wire::BlockMemberT>();
  member->name = resourceName(program, kind.variables, variable);
  member->type = ask(GL_TYPE);
  member->offset = ask(GL_OFFSET);
  member->count = ask(GL_ARRAY_SIZE);
  member->stride = ask(GL_ARRAY_STRIDE);
  if (kind.use == wire::BufferUse::AtomicCounters) return member;
  member->matrix_stride = ask(GL_MATRIX_STRIDE);
  member->row_major = ask(GL_IS_ROW_MAJOR) != 0;
  if (kind.use == wire::BufferUse::UniformBlock) return member;
  member->outer_count = ask(GL_TOP_LEVEL_ARRAY_SIZE);
  member->outer_stride = ask(GL_TOP_LEVEL_ARRAY_STRIDE);
  // An array at the block's own level is its own outermost one.
  if (member->outer_stride == 0 ||
      (member->outer_stride == member->stride && member->count == member->outer_count))
    member->outer_count = 1, member->outer_stride = 0;
  return member;
}

void addBlocks(GLuint program, const BlockKind& kind, std::vector<Bound>& list) {
  GLint count = 0;
  gl().GetProgramInterfaceiv(program, kind.blocks, GL_ACTIVE_RESOURCES, &count);
  if (guard::clearErrors()) return;  // this context has no such blocks
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    auto bound = std::make_unique<wire::BoundBufferT>();
    bound->use = kind.use;
    if (kind.use != wire::BufferUse::AtomicCounters) bound->name = resourceName(program, kind.blocks, i);
    bound->index = resource(program, kind.blocks, i, GL_BUFFER_BINDING);
    const auto at = static_cast<GLuint>(bound->index);
    setRange(*bound, static_cast<GLuint>(indexed(kind.binding, at)), indexed(kind.start, at),
             indexed(kind.size, at));
    const GLint variables = resource(program, kind.blocks, i, GL_NUM_ACTIVE_VARIABLES);
    std::vector<GLint> members(static_cast<std::size_t>(std::max(variables, 0)));
    constexpr GLenum kVariables = GL_ACTIVE_VARIABLES;
    if (variables > 0)
      gl().GetProgramResourceiv(program, kind.blocks, i, 1, &kVariables, variables, nullptr, members.data());
    if (guard::clearErrors()) members.clear();
    for (const GLint member : members)
      bound->members.push_back(memberAt(program, kind, static_cast<GLuint>(member)));
    std::stable_sort(bound->members.begin(), bound->members.end(),
                     [](const auto& a, const auto& b) { return a->offset < b->offset; });
    list.push_back(std::move(bound));
  }
}

GLint attribute(GLuint index, GLenum name) {
  GLint value = 0;
  gl().GetVertexAttribiv(index, name, &value);
  return guard::clearErrors() ? 0 : value;
}

// Where the attribute's elements begin, and how far apart they are: of the binding that it reads, where there
// are such.
void placeAttribute(const guard::ContextFacts& context, GLuint index, wire::BoundBufferT& bound) {
  const auto buffer = static_cast<GLuint>(attribute(index, GL_VERTEX_ATTRIB_ARRAY_BUFFER_BINDING));
  GLint64 offset = 0;
  if (context.atLeast(43, 31) || context.has("GL_ARB_vertex_attrib_binding")) {
    const auto binding = static_cast<GLuint>(attribute(index, GL_VERTEX_ATTRIB_BINDING));
    offset = indexed(GL_VERTEX_BINDING_OFFSET, binding) + attribute(index, GL_VERTEX_ATTRIB_RELATIVE_OFFSET);
    bound.stride = static_cast<int>(indexed(GL_VERTEX_BINDING_STRIDE, binding));
    bound.divisor = static_cast<int>(indexed(GL_VERTEX_BINDING_DIVISOR, binding));
  } else {
    void* pointer = nullptr;
    gl().GetVertexAttribPointerv(index, GL_VERTEX_ATTRIB_ARRAY_POINTER, &pointer);
    if (guard::clearErrors()) pointer = nullptr;
    offset = static_cast<GLint64>(reinterpret_cast<std::uintptr_t>(pointer));
    bound.stride = attribute(index, GL_VERTEX_ATTRIB_ARRAY_STRIDE);
    bound.divisor = attribute(index, GL_VERTEX_ATTRIB_ARRAY_DIVISOR);
  }
  if (buffer == 0)
    bound.reason = "the vertices lie in the program's own memory, in no buffer";
  else
    setRange(bound, buffer, offset, 0);
}

void addAttributes(const guard::ContextFacts& context, GLuint program, std::vector<Bound>& list) {
  GLint count = 0;
  gl().GetProgramiv(program, GL_ACTIVE_ATTRIBUTES, &count);
  if (guard::clearErrors()) return;
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    std::array<char, 256> name{};
    GLint size = 0;
    GLenum type = 0;
    gl().GetActiveAttrib(program, i, name.size(), nullptr, &size, &type, name.data());
    const GLint location = gl().GetAttribLocation(program, name.data());
    if (guard::clearErrors() || location < 0) continue;  // gl_VertexID and the like
    auto bound = std::make_unique<wire::BoundBufferT>();
    bound->use = wire::BufferUse::Vertices;
    bound->name = name.data();
    bound->index = location;
    const auto index = static_cast<GLuint>(location);
    if (attribute(index, GL_VERTEX_ATTRIB_ARRAY_ENABLED) == 0) {
      bound->reason = "its array is off: all vertices have one value, which stands in the state";
    } else {
      bound->components = attribute(index, GL_VERTEX_ATTRIB_ARRAY_SIZE);
      bound->type = static_cast<std::uint32_t>(attribute(index, GL_VERTEX_ATTRIB_ARRAY_TYPE));
      bound->normalized = attribute(index, GL_VERTEX_ATTRIB_ARRAY_NORMALIZED) != 0;
      placeAttribute(context, index, *bound);
    }
    list.push_back(std::move(bound));
  }
}

void addPlain(wire::BufferUse use, GLenum binding, std::vector<Bound>& list, GLenum type = 0) {
  const GLint buffer = integer(binding);
  if (buffer == 0) return;
  auto bound = std::make_unique<wire::BoundBufferT>();
  bound->use = use;
  bound->type = type;
  setRange(*bound, static_cast<GLuint>(buffer), 0, 0);
  list.push_back(std::move(bound));
}

void addFeedback(const guard::ContextFacts& context, std::vector<Bound>& list) {
  if (!context.transformFeedback()) return;
  const GLint most = integer(GL_MAX_TRANSFORM_FEEDBACK_SEPARATE_ATTRIBS);
  for (GLuint i = 0; i < static_cast<GLuint>(std::clamp(most, 0, 64)); ++i) {
    const auto buffer = static_cast<GLuint>(indexed(GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, i));
    if (buffer == 0) continue;
    auto bound = std::make_unique<wire::BoundBufferT>();
    bound->use = wire::BufferUse::Feedback;
    bound->index = static_cast<int>(i);
    setRange(*bound, buffer, indexed(GL_TRANSFORM_FEEDBACK_BUFFER_START, i),
             indexed(GL_TRANSFORM_FEEDBACK_BUFFER_SIZE, i));
    list.push_back(std::move(bound));
  }
}

}  // namespace

guard::OrRefusal<wire::BuffersT> describeBuffers(const DrawFacts& facts) {
  if (!copies()) return guard::unsupported("this driver cannot copy buffers (OpenGL 3.1, OpenGL ES 3.0)");
  const guard::ContextFacts& context = facts.context;
  const guard::CopyBindingGuard bindings;
  std::set<GLuint> programs;
  if (facts.program != 0) programs.insert(facts.program);
  for (const replay::StageProgram& stage : facts.stages) programs.insert(stage.program);
  wire::BuffersT answer;
  for (const GLuint program : programs) {
    if (!context.interfaceQueries()) break;
    for (const BlockKind& kind : kBlockKinds) addBlocks(program, kind, answer.buffers);
  }
  const GLuint vertices = facts.program == 0 ? 0 : originalOf(facts, wire::Stage::Vertex).program;
  if (vertices != 0) addAttributes(context, vertices, answer.buffers);
  if (facts.index_type != 0)
    addPlain(wire::BufferUse::Indices, GL_ELEMENT_ARRAY_BUFFER_BINDING, answer.buffers, facts.index_type);
  if (context.atLeast(40, 31))
    addPlain(wire::BufferUse::Commands, GL_DRAW_INDIRECT_BUFFER_BINDING, answer.buffers);
  if (context.atLeast(43, 31))
    addPlain(wire::BufferUse::Commands, GL_DISPATCH_INDIRECT_BUFFER_BINDING, answer.buffers);
  addFeedback(context, answer.buffers);
  return answer;
}

guard::OrRefusal<wire::BufferBytesT> readBuffer(const DrawFacts& facts, const wire::ReadBufferT& request,
                                                AnswerMemory& bulk) {
  if (!copies()) return guard::unsupported("this driver cannot copy buffers (OpenGL 3.1, OpenGL ES 3.0)");
  const guard::CopyBindingGuard bindings;
  if (!gl().IsBuffer(request.buffer))
    return guard::unsupported("there is no buffer " + std::to_string(request.buffer));
  const auto size = static_cast<std::uint64_t>(guard::bufferSize(request.buffer));
  if (request.bytes == 0 || request.offset > size || request.bytes > size - request.offset)
    return guard::unsupported("buffer " + std::to_string(request.buffer) + " holds " + std::to_string(size) +
                              " bytes; these are not among them");
  BulkLayout layout;
  wire::BufferBytesT answer;
  answer.range = layout.add(request.bytes);
  if (!layout.create(bulk)) return noMemory();
  if (facts.context.atLeast(42, 31)) gl().MemoryBarrier(GL_ALL_BARRIER_BITS);
  if (!guard::readBytes(request.buffer, static_cast<GLint64>(request.offset),
                        static_cast<GLint64>(request.bytes), bulk.data()))
    return guard::unsupported("buffer " + std::to_string(request.buffer) +
                              " cannot be read: the program has mapped it, or there is no memory for a copy");
  return answer;
}

}  // namespace shadestep::agent
