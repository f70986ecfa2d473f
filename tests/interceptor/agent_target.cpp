// agent_target NAME OUT: two draws into a target of a certain kind, then what it holds, as floats, to OUT:
// all samples of layer 0, of layer 1, ... The second draw's fragments say in the colour where they are, and
// have alpha 1; those of the first have another. Nothing here knows of the debugger.
#include "agent_scene.h"

#include <GL/osmesa.h>
#include <unistd.h>

#include <cstring>
#include <map>

namespace {

constexpr int kWidth = scene::kWidth, kHeight = scene::kHeight;
constexpr int kSamples = 4, kLayers = 3;

// Newer than what libOSMesa exports by name.
template <class Function>
Function opened(const char* name) {
  return reinterpret_cast<Function>(OSMesaGetProcAddress(name));
}

constexpr const char* kVertex =
    "#version 400 compatibility\n"
    "uniform float slope;\n"
    "void main() { gl_Position = vec4(gl_Vertex.xy, slope * gl_Vertex.x, 1.0); }\n";
constexpr const char* kFragment =
    "#version 400 compatibility\n"
    "uniform float mine;\n"
    "out vec4 color;\n"
    "void main() { color = vec4(gl_FragCoord.xy, 3.0, mine); }\n";
constexpr const char* kSampleFragment =
    "#version 400 compatibility\n"
    "uniform float mine;\n"
    "out vec4 color;\n"
    "void main() { color = vec4(gl_FragCoord.xy, float(gl_SampleID), mine); }\n";
constexpr const char* kLayersGeometry =
    "#version 400 compatibility\n"
    "layout(triangles, invocations = 2) in;\n"
    "layout(triangle_strip, max_vertices = 3) out;\n"
    "void main() {\n"
    "  for (int i = 0; i < 3; ++i) {\n"
    "    gl_Layer = gl_InvocationID + 1;\n"
    "    gl_Position = gl_in[i].gl_Position + vec4(0.2 * float(gl_InvocationID), 0.0, 0.0, 0.0);\n"
    "    EmitVertex();\n"
    "  }\n"
    "  EndPrimitive();\n"
    "}\n";
constexpr const char* kLayerFragment =
    "#version 430 compatibility\n"
    "uniform float mine;\n"
    "out vec4 color;\n"
    "void main() { color = vec4(gl_FragCoord.xy, float(gl_Layer), mine); }\n";

constexpr GLfloat kCorners[] = {-0.93F, -0.87F, 0.95F, -0.71F, 0.03F, 0.91F, -1, -1, 3, -1, -1, 3};

GLuint use(const char* fragment, const char* geometry = nullptr) {
  const GLuint program = glCreateProgram();
  glAttachShader(program, scene::compile(GL_VERTEX_SHADER, {kVertex}));
  glAttachShader(program, scene::compile(GL_FRAGMENT_SHADER, {fragment}));
  if (geometry != nullptr) glAttachShader(program, scene::compile(GL_GEOMETRY_SHADER, {geometry}));
  glLinkProgram(program);
  glUseProgram(program);
  return program;
}

// The second draw is behind the first in one half of the target.
void drawTwice(GLuint program) {
  glClearColor(0.125F, 0.25F, 0.375F, 0.5F);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  glUniform1f(glGetUniformLocation(program, "mine"), 0.25F);
  glUniform1f(glGetUniformLocation(program, "slope"), 0.3F);
  glDrawArrays(GL_TRIANGLES, 3, 3);
  glUniform1f(glGetUniformLocation(program, "mine"), 1.0F);
  glUniform1f(glGetUniformLocation(program, "slope"), -0.4F);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

// ---- what a target holds
// ----------------------------------------------------------------------------------------

std::vector<float> pixels;

void readFramebuffer() {
  const std::size_t start = pixels.size();
  pixels.resize(start + static_cast<std::size_t>(kWidth) * kHeight * 4);
  glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_FLOAT, pixels.data() + start);
}

// By a program of the scene's own.
void readSamples(GLenum target, GLuint texture, int layers) {
  const bool array = target == GL_TEXTURE_2D_MULTISAMPLE_ARRAY;
  const std::string text =
      std::string("#version 400 compatibility\nuniform sampler2DMS") + (array ? "Array" : "") +
      " image;\nuniform int layer, at;\nout vec4 value;\n" + "void main() { value = texelFetch(image, " +
      (array ? "ivec3(gl_FragCoord.xy, layer)" : "ivec2(gl_FragCoord.xy)") + ", at); }\n";
  const GLuint program = use(text.c_str());
  GLuint color = 0;
  GLuint framebuffer = 0;
  glGenRenderbuffers(1, &color);
  glBindRenderbuffer(GL_RENDERBUFFER, color);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA32F, kWidth, kHeight);
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
  glDisable(GL_DEPTH_TEST);
  glBindTexture(target, texture);
  for (int layer = 0; layer < layers; ++layer) {
    for (int sample = 0; sample < kSamples; ++sample) {
      glUniform1i(glGetUniformLocation(program, "layer"), layer);
      glUniform1i(glGetUniformLocation(program, "at"), sample);
      glDrawArrays(GL_TRIANGLES, 3, 3);
      readFramebuffer();
    }
  }
}

void readTexture(GLenum target, GLuint texture, int layers) {
  glBindTexture(target, texture);
  const std::size_t layer = static_cast<std::size_t>(kWidth) * kHeight * 4;
  pixels.resize(layer * static_cast<std::size_t>(layers));
  if (target != GL_TEXTURE_CUBE_MAP) {
    glGetTexImage(target, 0, GL_RGBA, GL_FLOAT, pixels.data());
    return;
  }
  for (GLenum face = 0; face < 6; ++face) {
    std::vector<float> all(static_cast<std::size_t>(kWidth) * kWidth * 4);
    glGetTexImage(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, GL_RGBA, GL_FLOAT, all.data());
    std::memcpy(pixels.data() + layer * face, all.data(), layer * sizeof(float));  // the rows that count
  }
}

// ---- samples
// ----------------------------------------------------------------------------------------------------

GLuint newFramebuffer() {
  GLuint framebuffer = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  return framebuffer;
}

GLuint multisampledTexture(GLenum target, GLenum format) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(target, texture);
  if (target == GL_TEXTURE_2D_MULTISAMPLE) {
    opened<PFNGLTEXIMAGE2DMULTISAMPLEPROC>("glTexImage2DMultisample")(target, kSamples, format, kWidth,
                                                                      kHeight, GL_TRUE);
  } else {
    opened<PFNGLTEXIMAGE3DMULTISAMPLEPROC>("glTexImage3DMultisample")(target, kSamples, format, kWidth,
                                                                      kHeight, kLayers, GL_TRUE);
  }
  opened<PFNGLFRAMEBUFFERTEXTUREPROC>("glFramebufferTexture")(
      GL_FRAMEBUFFER, format == GL_DEPTH24_STENCIL8 ? GL_DEPTH_STENCIL_ATTACHMENT : GL_COLOR_ATTACHMENT0,
      texture, 0);
  return texture;
}

void multisampled(const char* fragment) {
  newFramebuffer();
  const GLuint color = multisampledTexture(GL_TEXTURE_2D_MULTISAMPLE, GL_RGBA32F);
  multisampledTexture(GL_TEXTURE_2D_MULTISAMPLE, GL_DEPTH24_STENCIL8);
  glEnable(GL_STENCIL_TEST);
  glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
  drawTwice(use(fragment));
  glDisable(GL_STENCIL_TEST);
  readSamples(GL_TEXTURE_2D_MULTISAMPLE, color, 1);
}

void samples() {
  multisampled(kFragment);
}

void sampleShading() {
  multisampled(kSampleFragment);
}

// As most programs do it: renderbuffers, averaged afterwards.
void multisampledRenderbuffers() {
  newFramebuffer();
  GLuint buffers[2];
  glGenRenderbuffers(2, buffers);
  glBindRenderbuffer(GL_RENDERBUFFER, buffers[0]);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, kSamples, GL_RGBA8, kWidth, kHeight);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers[0]);
  glBindRenderbuffer(GL_RENDERBUFFER, buffers[1]);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, kSamples, GL_DEPTH_COMPONENT24, kWidth, kHeight);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, buffers[1]);
  drawTwice(
      use("#version 400 compatibility\nuniform float mine;\nout vec4 color;\n"
          "void main() { color = vec4(gl_FragCoord.xy / 64.0, 0.75, mine); }\n"));
}

// ---- layers
// -----------------------------------------------------------------------------------------------------

GLuint layeredTexture(GLenum target, GLenum format, GLenum attachment, int layers) {
  const GLenum data = format == GL_DEPTH_COMPONENT32F ? GL_DEPTH_COMPONENT : GL_RGBA;
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(target, texture);
  glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  if (target == GL_TEXTURE_CUBE_MAP) {
    for (GLenum face = 0; face < 6; ++face) {
      glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, static_cast<GLint>(format), kWidth, kWidth, 0,
                   data, GL_FLOAT, nullptr);
    }
  } else {
    glTexImage3D(target, 0, static_cast<GLint>(format), kWidth, kHeight, layers, 0, data, GL_FLOAT, nullptr);
  }
  opened<PFNGLFRAMEBUFFERTEXTUREPROC>("glFramebufferTexture")(GL_FRAMEBUFFER, attachment, texture, 0);
  return texture;
}

void layeredArray() {
  newFramebuffer();
  layeredTexture(GL_TEXTURE_2D_ARRAY, GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT, kLayers);
  const GLuint color = layeredTexture(GL_TEXTURE_2D_ARRAY, GL_RGBA32F, GL_COLOR_ATTACHMENT0, kLayers);
  drawTwice(use(kLayerFragment, kLayersGeometry));
  readTexture(GL_TEXTURE_2D_ARRAY, color, kLayers);
}

// Every thread left of column 16 ends in a discard, of every layer or sample.
constexpr const char* kDiscardingSamples =
    "#version 400 compatibility\n"
    "uniform float mine;\n"
    "out vec4 color;\n"
    "void main() {\n"
    "  color = vec4(gl_FragCoord.xy, float(gl_SampleID), mine);\n"
    "  if (gl_FragCoord.x < 16.0) discard;\n"
    "}\n";
constexpr const char* kDiscardingLayers =
    "#version 430 compatibility\n"
    "uniform float mine;\n"
    "out vec4 color;\n"
    "void main() {\n"
    "  color = vec4(gl_FragCoord.xy, float(gl_Layer), mine);\n"
    "  if (gl_FragCoord.x < 16.0) discard;\n"
    "}\n";

void discardingSamples() {
  newFramebuffer();
  const GLuint color = multisampledTexture(GL_TEXTURE_2D_MULTISAMPLE, GL_RGBA32F);
  drawTwice(use(kDiscardingSamples));
  readSamples(GL_TEXTURE_2D_MULTISAMPLE, color, 1);
}

void discardingLayers() {
  newFramebuffer();
  const GLuint color = layeredTexture(GL_TEXTURE_2D_ARRAY, GL_RGBA32F, GL_COLOR_ATTACHMENT0, kLayers);
  drawTwice(use(kDiscardingLayers, kLayersGeometry));
  readTexture(GL_TEXTURE_2D_ARRAY, color, kLayers);
}

// Tests come before the shader: what it writes as depth counts for nothing, a discarded fragment's own depth
// is written all the same, and hidden fragments do not run.
void earlyTests() {
  newFramebuffer();
  layeredTexture(GL_TEXTURE_2D_ARRAY, GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT, kLayers);
  const GLuint color = layeredTexture(GL_TEXTURE_2D_ARRAY, GL_RGBA32F, GL_COLOR_ATTACHMENT0, kLayers);
  drawTwice(use(
      "#version 420 compatibility\nlayout(early_fragment_tests) in;\nuniform float mine;\nout vec4 color;\n"
      "void main() {\n"
      "  float column = floor(gl_FragCoord.x);\n"
      "  gl_FragDepth = 1.0;\n"
      "  if (mod(column, 2.0) == 1.0) discard;\n"
      "  color = vec4(gl_FragCoord.xy, column, mine);\n"
      "}\n"));
  readTexture(GL_TEXTURE_2D_ARRAY, color, kLayers);
}

void layeredCube() {
  newFramebuffer();
  const GLuint color = layeredTexture(GL_TEXTURE_CUBE_MAP, GL_RGBA32F, GL_COLOR_ATTACHMENT0, 6);
  drawTwice(use(kLayerFragment, kLayersGeometry));
  readTexture(GL_TEXTURE_CUBE_MAP, color, 6);
}

void layeredVolume() {
  newFramebuffer();
  const GLuint color = layeredTexture(GL_TEXTURE_3D, GL_RGBA32F, GL_COLOR_ATTACHMENT0, kLayers);
  drawTwice(use(kLayerFragment, kLayersGeometry));
  readTexture(GL_TEXTURE_3D, color, kLayers);
}

void layeredSamples() {
  newFramebuffer();
  const GLuint color = multisampledTexture(GL_TEXTURE_2D_MULTISAMPLE_ARRAY, GL_RGBA32F);
  multisampledTexture(GL_TEXTURE_2D_MULTISAMPLE_ARRAY, GL_DEPTH24_STENCIL8);
  drawTwice(use(kLayerFragment, kLayersGeometry));
  readSamples(GL_TEXTURE_2D_MULTISAMPLE_ARRAY, color, kLayers);
}

// One slice of a volume is an ordinary target.
void slice() {
  newFramebuffer();
  const GLuint color = layeredTexture(GL_TEXTURE_3D, GL_RGBA32F, GL_COLOR_ATTACHMENT0, kLayers);
  glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, color, 0, 2);
  drawTwice(use(kFragment));
  readFramebuffer();
}

void cubeFace() {
  newFramebuffer();
  const GLuint color = layeredTexture(GL_TEXTURE_CUBE_MAP, GL_RGBA32F, GL_COLOR_ATTACHMENT0, 6);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_CUBE_MAP_NEGATIVE_Y, color, 0);
  drawTwice(use(kFragment));
  readFramebuffer();
}

// ---- no colour
// --------------------------------------------------------------------------------------------------

constexpr const char* kCounting =
    "#version 430 compatibility\n"
    "layout(std430, binding = 0) buffer Cells { uint cells[]; };\n"
    "void main() {\n"
    "  vec4 color; color = vec4(gl_FragCoord.xy, 3.0, 1.0);\n"
    "  cells[int(gl_FragCoord.y) * 48 + int(gl_FragCoord.x)] += 1u;\n"
    "}\n";

void noAttachments(int samples) {
  const auto set = opened<PFNGLFRAMEBUFFERPARAMETERIPROC>("glFramebufferParameteri");
  newFramebuffer();
  set(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_WIDTH, kWidth);
  set(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_HEIGHT, kHeight);
  set(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_SAMPLES, samples);
  const std::vector<GLuint> zeros(static_cast<std::size_t>(kWidth) * kHeight);
  GLuint cells = 0;
  glGenBuffers(1, &cells);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, cells);
  glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(zeros.size() * 4), zeros.data(),
               GL_STATIC_READ);
  use(kCounting);
  glDrawArrays(GL_TRIANGLES, 3, 3);
  std::vector<GLuint> counted(zeros.size());
  glBindBuffer(GL_COPY_READ_BUFFER, cells);
  glGetBufferSubData(GL_COPY_READ_BUFFER, 0, static_cast<GLsizeiptr>(counted.size() * 4), counted.data());
  for (const GLuint count : counted) pixels.push_back(static_cast<float>(count));
}

void empty() {
  noAttachments(0);
}

void emptySamples() {
  noAttachments(kSamples);
}

void depthOnly() {
  newFramebuffer();
  GLuint depth = 0;
  glGenRenderbuffers(1, &depth);
  glBindRenderbuffer(GL_RENDERBUFFER, depth);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT16, kWidth, kHeight);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
  glDrawBuffer(GL_NONE);
  drawTwice(
      use("#version 400 compatibility\nuniform float mine;\n"
          "void main() { vec4 color; color = vec4(gl_FragCoord.xy, 3.0, mine); }\n"));
  pixels.resize(static_cast<std::size_t>(kWidth) * kHeight);
  glReadPixels(0, 0, kWidth, kHeight, GL_DEPTH_COMPONENT, GL_FLOAT, pixels.data());
}

// ---- formats and operations
// -------------------------------------------------------------------------------------

void texture2D(GLint format, GLenum data, GLenum type) {
  newFramebuffer();
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexImage2D(GL_TEXTURE_2D, 0, format, kWidth, kHeight, 0, data, type, nullptr);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
}

constexpr const char* kNormalized =
    "#version 400 compatibility\nuniform float mine;\nout vec4 color;\n"
    "void main() { color = vec4(gl_FragCoord.xy / 64.0, 0.7, mine); }\n";

void normalized(GLint format) {
  texture2D(format, GL_RGBA, GL_FLOAT);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) std::exit(77);
  drawTwice(use(kNormalized));
  readFramebuffer();
}

void srgb() {
  glEnable(GL_FRAMEBUFFER_SRGB);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_SRC_COLOR);
  normalized(GL_SRGB8_ALPHA8);
}

void srgbSamples() {
  newFramebuffer();
  multisampledTexture(GL_TEXTURE_2D_MULTISAMPLE, GL_SRGB8_ALPHA8);
  glEnable(GL_FRAMEBUFFER_SRGB);
  drawTwice(use(kNormalized));
}

void integers() {
  texture2D(GL_RG16I, GL_RG_INTEGER, GL_INT);
  const GLuint program =
      use("#version 400 compatibility\nuniform float mine;\nout ivec4 color;\n"
          "void main() { color = ivec4(ivec2(gl_FragCoord.xy) * -100, 7, int(mine)); }\n");
  drawTwice(program);
}

void dualSource() {
  texture2D(GL_RGBA32F, GL_RGBA, GL_FLOAT);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_SRC1_COLOR);
  drawTwice(use(
      "#version 400 compatibility\nuniform float mine;\n"
      "layout(location = 0, index = 0) out vec4 color;\nlayout(location = 0, index = 1) out vec4 weight;\n"
      "void main() { weight = vec4(0.5, 0.25, 2.0, 0.0); color = vec4(gl_FragCoord.xy, 3.0, mine); }\n"));
  readFramebuffer();
}

void logicOperation() {
  texture2D(GL_RGBA8, GL_RGBA, GL_FLOAT);
  glEnable(GL_COLOR_LOGIC_OP);
  glLogicOp(GL_XOR);
  drawTwice(use(kNormalized));
  readFramebuffer();
}

void clamped() {
  texture2D(GL_RGBA32F, GL_RGBA, GL_FLOAT);
  glClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_TRUE);
  drawTwice(use(kFragment));
  readFramebuffer();
}

void alphaToOne() {
  newFramebuffer();
  const GLuint color = multisampledTexture(GL_TEXTURE_2D_MULTISAMPLE, GL_RGBA32F);
  glEnable(GL_SAMPLE_ALPHA_TO_ONE);
  drawTwice(use(kFragment));
  readSamples(GL_TEXTURE_2D_MULTISAMPLE, color, 1);
}

using Scene = void (*)();
const std::map<std::string, Scene>& scenes() {
  static const std::map<std::string, Scene> all = {
      {"samples", samples},
      {"sample-shading", sampleShading},
      {"multisampled-renderbuffers", multisampledRenderbuffers},
      {"layered-array", layeredArray},
      {"discarding-samples", discardingSamples},
      {"discarding-layers", discardingLayers},
      {"early-tests", earlyTests},
      {"layered-cube", layeredCube},
      {"layered-volume", layeredVolume},
      {"layered-samples", layeredSamples},
      {"slice", slice},
      {"cube-face", cubeFace},
      {"empty", empty},
      {"empty-samples", emptySamples},
      {"depth-only", depthOnly},
      {"alpha", [] { normalized(GL_ALPHA8); }},
      {"luminance", [] { normalized(GL_LUMINANCE8); }},
      {"luminance-alpha", [] { normalized(GL_LUMINANCE8_ALPHA8); }},
      {"intensity", [] { normalized(GL_INTENSITY8); }},
      {"unsized", [] { normalized(GL_RGBA); }},
      {"small", [] { normalized(GL_RGB565); }},
      {"packed-float", [] { normalized(GL_R11F_G11F_B10F); }},
      {"half", [] { normalized(GL_RG16F); }},
      {"signed", [] { normalized(GL_RGBA16_SNORM); }},
      {"srgb", srgb},
      {"srgb-samples", srgbSamples},
      {"integers", integers},
      {"dual-source", dualSource},
      {"logic-op", logicOperation},
      {"clamped", clamped},
      {"alpha-to-one", alphaToOne},
  };
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  const auto scene = scenes().find(argc > 1 ? argv[1] : "");
  if (scene == scenes().end()) return 2;
  alarm(120);  // a hang is a failure too
  const int attributes[] = {OSMESA_FORMAT, OSMESA_RGBA, OSMESA_PROFILE, OSMESA_COMPAT_PROFILE, 0};
  OSMesaContext context = OSMesaCreateContextAttribs(attributes, nullptr);
  std::vector<unsigned char> buffer(static_cast<std::size_t>(kWidth) * kHeight * 4);
  if (!OSMesaMakeCurrent(context, buffer.data(), GL_UNSIGNED_BYTE, kWidth, kHeight)) return 5;
  glEnableClientState(GL_VERTEX_ARRAY);
  glVertexPointer(2, GL_FLOAT, 0, kCorners);
  scene->second();
  if (glGetError() != GL_NO_ERROR) return 1;
  if (argc < 3) return 0;
  std::FILE* file = std::fopen(argv[2], "wb");
  if (file == nullptr || std::fwrite(pixels.data(), sizeof(float), pixels.size(), file) != pixels.size())
    return 4;
  std::fclose(file);
  return 0;
}
