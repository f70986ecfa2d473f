// agent_memory OUT: pairs of draws whose fragments add to what is in memory: images of every format that
// shaders can write, images of every kind, storage that stays mapped, storage behind early fragment tests.
// What is there after each pair goes to OUT. `agent_memory --list` prints the pairs' names. Nothing here
// knows of the debugger.
#include "agent_scene.h"

#include <GL/osmesa.h>
#include <unistd.h>

#include <cstring>

namespace {

constexpr int kSize = 16;

// Newer than what libOSMesa exports by name.
template <class Function>
Function opened(const char* name) {
  return reinterpret_cast<Function>(OSMesaGetProcAddress(name));
}

std::FILE* out = nullptr;
void keep(const void* data, std::size_t bytes) {
  if (std::fwrite(data, 1, bytes, out) != bytes) std::exit(4);
}

constexpr const char* kVertex =
    "#version 430 compatibility\nvoid main() { gl_Position = vec4(gl_Vertex.xy, 0.5 * gl_Vertex.x, 1.0); }\n";
constexpr GLfloat kCorners[] = {-1, -1, 3, -1, -1, 3};

void drawTwice(const std::string& fragment) {
  const GLuint program = glCreateProgram();
  glAttachShader(program, scene::compile(GL_VERTEX_SHADER, {kVertex}));
  glAttachShader(program, scene::compile(GL_FRAGMENT_SHADER, {fragment.c_str()}));
  glLinkProgram(program);
  glUseProgram(program);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  opened<PFNGLMEMORYBARRIERPROC>("glMemoryBarrier")(GL_ALL_BARRIER_BITS);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  opened<PFNGLMEMORYBARRIERPROC>("glMemoryBarrier")(GL_ALL_BARRIER_BITS);
  glDeleteProgram(program);
}

// ---- images
// -----------------------------------------------------------------------------------------------------

// OpenGL 4.6, table 8.33, as GLSL spells it.
struct Format {
  const char* name;
  GLenum internal;
  char type;  // 'f'loat, normalized included, 'i'nt, 'u'int
};
constexpr Format kFormats[] = {
    {"rgba32f", GL_RGBA32F, 'f'},
    {"rgba16f", GL_RGBA16F, 'f'},
    {"rg32f", GL_RG32F, 'f'},
    {"rg16f", GL_RG16F, 'f'},
    {"r11f_g11f_b10f", GL_R11F_G11F_B10F, 'f'},
    {"r32f", GL_R32F, 'f'},
    {"r16f", GL_R16F, 'f'},
    {"rgba16", GL_RGBA16, 'f'},
    {"rgb10_a2", GL_RGB10_A2, 'f'},
    {"rgba8", GL_RGBA8, 'f'},
    {"rg16", GL_RG16, 'f'},
    {"rg8", GL_RG8, 'f'},
    {"r16", GL_R16, 'f'},
    {"r8", GL_R8, 'f'},
    {"rgba16_snorm", GL_RGBA16_SNORM, 'f'},
    {"rgba8_snorm", GL_RGBA8_SNORM, 'f'},
    {"rg16_snorm", GL_RG16_SNORM, 'f'},
    {"rg8_snorm", GL_RG8_SNORM, 'f'},
    {"r16_snorm", GL_R16_SNORM, 'f'},
    {"r8_snorm", GL_R8_SNORM, 'f'},
    {"rgba32i", GL_RGBA32I, 'i'},
    {"rgba16i", GL_RGBA16I, 'i'},
    {"rgba8i", GL_RGBA8I, 'i'},
    {"rg32i", GL_RG32I, 'i'},
    {"rg16i", GL_RG16I, 'i'},
    {"rg8i", GL_RG8I, 'i'},
    {"r32i", GL_R32I, 'i'},
    {"r16i", GL_R16I, 'i'},
    {"r8i", GL_R8I, 'i'},
    {"rgba32ui", GL_RGBA32UI, 'u'},
    {"rgba16ui", GL_RGBA16UI, 'u'},
    {"rgb10_a2ui", GL_RGB10_A2UI, 'u'},
    {"rgba8ui", GL_RGBA8UI, 'u'},
    {"rg32ui", GL_RG32UI, 'u'},
    {"rg16ui", GL_RG16UI, 'u'},
    {"rg8ui", GL_RG8UI, 'u'},
    {"r32ui", GL_R32UI, 'u'},
    {"r16ui", GL_R16UI, 'u'},
    {"r8ui", GL_R8UI, 'u'},
};

struct Kind {
  const char* image;  // of the type's name
  GLenum target;
  const char* place;
  int height, depth;  // 0 = has none
  int level;
};
constexpr Kind kKinds[] = {
    {"2D", GL_TEXTURE_2D, "place", kSize, 0, 0},
    {"2D", GL_TEXTURE_2D, "place", kSize, 0, 1},
    {"1D", GL_TEXTURE_1D, "place.x", 0, 0, 0},
    {"2DRect", GL_TEXTURE_RECTANGLE, "place", kSize, 0, 0},
    {"3D", GL_TEXTURE_3D, "ivec3(place, place.x % 3)", kSize, 3, 0},
    {"Cube", GL_TEXTURE_CUBE_MAP, "ivec3(place, place.x % 6)", kSize, 0, 0},
    {"1DArray", GL_TEXTURE_1D_ARRAY, "place", kSize, 0, 0},
    {"2DArray", GL_TEXTURE_2D_ARRAY, "ivec3(place, place.x % 3)", kSize, 3, 0},
    {"CubeArray", GL_TEXTURE_CUBE_MAP_ARRAY, "ivec3(place, place.x % 12)", kSize, 12, 0},
};

GLenum dataFormat(const Format& format) {
  return format.type == 'f' ? GL_RGBA : GL_RGBA_INTEGER;
}
GLenum dataType(const Format& format) {
  return format.type == 'f' ? GL_FLOAT : format.type == 'i' ? GL_INT : GL_UNSIGNED_INT;
}

void allocate(const Kind& kind, const Format& format, int level) {
  const int size = kind.level == 1 && level == 0 ? 2 * kSize : kSize;
  const int depth = kind.depth > 0 ? kind.depth : 1;
  std::vector<GLuint> words(static_cast<std::size_t>(size) * static_cast<std::size_t>(size) *
                            static_cast<std::size_t>(depth) * 4);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const GLfloat value = static_cast<GLfloat>(i % 7) / 16.0F;
    words[i] = static_cast<GLuint>(i % 50);
    if (format.type == 'f') std::memcpy(&words[i], &value, 4);
  }
  const auto internal = static_cast<GLint>(format.internal);
  if (kind.target == GL_TEXTURE_CUBE_MAP) {
    for (GLenum face = 0; face < 6; ++face) {
      glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, level, internal, size, size, 0, dataFormat(format),
                   dataType(format), words.data());
    }
  } else if (kind.height == 0) {
    glTexImage1D(kind.target, level, internal, size, 0, dataFormat(format), dataType(format), words.data());
  } else if (kind.depth == 0) {
    glTexImage2D(kind.target, level, internal, size, size, 0, dataFormat(format), dataType(format),
                 words.data());
  } else {
    glTexImage3D(kind.target, level, internal, size, size, depth, 0, dataFormat(format), dataType(format),
                 words.data());
  }
}

void image(const Kind& kind, const Format& format) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(kind.target, texture);
  if (kind.target != GL_TEXTURE_RECTANGLE) glTexParameteri(kind.target, GL_TEXTURE_MAX_LEVEL, kind.level);
  glTexParameteri(kind.target, GL_TEXTURE_MIN_FILTER,
                  kind.level == 0 ? GL_NEAREST : GL_NEAREST_MIPMAP_NEAREST);
  for (int level = 0; level <= kind.level; ++level) allocate(kind, format, level);
  opened<PFNGLBINDIMAGETEXTUREPROC>("glBindImageTexture")(2, texture, kind.level, GL_TRUE, 0, GL_READ_WRITE,
                                                          format.internal);
  const std::string prefix = format.type == 'f' ? "" : std::string(1, format.type);
  const std::string place = kind.place;
  // A line is written by many fragments: by those of one row only.
  drawTwice("#version 430 compatibility\nlayout(" + std::string(format.name) + ", binding = 2) uniform " +
            prefix + "image" + kind.image +
            " picture;\nout vec4 color;\nvoid main() {\n  ivec2 place = ivec2(gl_FragCoord.xy);\n" +
            (kind.height == 0 ? "  if (place.y == 3) {\n" : "  {\n") + "    " + prefix +
            "vec4 before = imageLoad(picture, " + place + ");\n    imageStore(picture, " + place +
            ", before + " + prefix + (format.type == 'f' ? "vec4(0.125)" : "vec4(3)") +
            ");\n  }\n  color = vec4(0.5);\n}\n");
  const std::size_t faces = kind.target == GL_TEXTURE_CUBE_MAP ? 6 : 1;
  std::vector<GLuint> words(static_cast<std::size_t>(kSize) * kSize * 4 *
                            static_cast<std::size_t>(kind.depth > 0 ? kind.depth : 1));
  for (std::size_t face = 0; face < faces; ++face) {
    const GLenum target =
        faces == 6 ? GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face) : kind.target;
    glGetTexImage(target, kind.level, dataFormat(format), dataType(format), words.data());
    keep(words.data(), words.size() * 4);
  }
  glDeleteTextures(1, &texture);
}

// ---- storage
// ----------------------------------------------------------------------------------------------------

std::string counting(const std::string& before) {
  return "#version 430 compatibility\n" + before +
         "layout(std430, binding = 1) buffer Cells { uint cells[]; };\nout vec4 color;\nvoid main() {\n"
         "  atomicAdd(cells[int(gl_FragCoord.y) * 16 + int(gl_FragCoord.x)], 1u);\n  color = vec4(0.5);\n}\n";
}

// Mapped for good: the program reads it without another call.
void mappedStorage() {
  const std::vector<GLuint> start(kSize * kSize, 5);
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, buffer);
  constexpr GLbitfield kAccess =
      GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  opened<PFNGLBUFFERSTORAGEPROC>("glBufferStorage")(GL_SHADER_STORAGE_BUFFER, kSize * kSize * 4, start.data(),
                                                    kAccess);
  const void* mapped = glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, kSize * kSize * 4, kAccess);
  drawTwice(counting(""));
  glFinish();
  keep(mapped, kSize * kSize * 4);
  glDeleteBuffers(1, &buffer);
}

// Fragments that the depth test hides count only where it comes after the shader.
void tested(const std::string& layout) {
  const std::vector<GLuint> zeros(kSize * kSize, 0);
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, buffer);
  glBufferData(GL_SHADER_STORAGE_BUFFER, kSize * kSize * 4, zeros.data(), GL_DYNAMIC_READ);
  glClearDepth(0.5);
  glClear(GL_DEPTH_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  drawTwice(counting(layout));
  glDepthMask(GL_TRUE);
  glDisable(GL_DEPTH_TEST);
  std::vector<GLuint> cells(zeros.size());
  glBindBuffer(GL_COPY_READ_BUFFER, buffer);
  glGetBufferSubData(GL_COPY_READ_BUFFER, 0, kSize * kSize * 4, cells.data());
  keep(cells.data(), cells.size() * 4);
  glDeleteBuffers(1, &buffer);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  if (std::strcmp(argv[1], "--list") == 0) {
    for (const Format& format : kFormats) std::printf("%s\n", format.name);
    for (const Kind& kind : kKinds) std::printf("image%s level %d\n", kind.image, kind.level);
    std::printf("mapped\nlate tests\nearly tests\n");
    return 0;
  }
  alarm(120);  // a hang is a failure too
  const int attributes[] = {
      OSMESA_FORMAT, OSMESA_RGBA, OSMESA_DEPTH_BITS, 24, OSMESA_PROFILE, OSMESA_COMPAT_PROFILE, 0};
  OSMesaContext context = OSMesaCreateContextAttribs(attributes, nullptr);
  std::vector<unsigned char> buffer(static_cast<std::size_t>(kSize) * kSize * 4);
  if (!OSMesaMakeCurrent(context, buffer.data(), GL_UNSIGNED_BYTE, kSize, kSize)) return 5;
  glEnableClientState(GL_VERTEX_ARRAY);
  glVertexPointer(2, GL_FLOAT, 0, kCorners);
  out = std::fopen(argv[1], "wb");
  if (out == nullptr) return 4;
  for (const Format& format : kFormats) image(kKinds[0], format);
  for (const Kind& kind : kKinds) image(kind, kFormats[36]);
  mappedStorage();
  tested("");
  tested("layout(early_fragment_tests) in;\n");
  std::fclose(out);
  return glGetError() == GL_NO_ERROR ? 0 : 1;
}
