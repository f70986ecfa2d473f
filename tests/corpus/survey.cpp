// How many of the fragment shaders that the driver compiles can be analysed?
//
//     survey [--reasons FILE] FOLDER...
//
// Takes every fragment shader out of the .shader_test and .frag files below the folders, each text once, asks
// the driver (surfaceless EGL) whether it compiles, analyses those that do, and asks again whether the text
// that the analysis would hand out compiles as well. Prints a row a directory; FILE gets a line for each
// shader that falls through.
#include <EGL/egl.h>
#include <EGL/eglext.h>
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "glsl-frontend/shader.h"

using namespace shadestep;

namespace {

// A stage of a test: its shader objects, as they would be linked.
struct Test {
  std::vector<std::string> objects;
  bool es = false;
};

class Driver {
 public:
  explicit Driver(EGLenum api) : api_(api) {
    const auto getPlatformDisplay =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYPROC>(eglGetProcAddress("eglGetPlatformDisplay"));
    display_ = getPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    eglInitialize(display_, nullptr, nullptr);
    eglBindAPI(api);
    const EGLint es[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 2, EGL_NONE};
    const EGLint none[] = {EGL_NONE};
    context_ =
        eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, api == EGL_OPENGL_ES_API ? es : none);
  }

  void use() const {
    eglBindAPI(api_);
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
  }

  frontend::PreprocessorFacts facts() const {
    frontend::PreprocessorFacts result;
    result.es = api_ == EGL_OPENGL_ES_API;
    GLint count = 0;
    glGetIntegerv(GL_NUM_EXTENSIONS, &count);
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
      result.extensions.emplace_back(reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, i)));
    }
    return result;
  }

  // Each object compiles; several of them also have to link.
  static bool takes(const std::vector<std::string>& objects) {
    const GLuint program = glCreateProgram();
    bool taken = true;
    for (const std::string& text : objects) {
      const GLuint shader = glCreateShader(GL_FRAGMENT_SHADER);
      const GLchar* string = text.c_str();
      glShaderSource(shader, 1, &string, nullptr);
      glCompileShader(shader);
      GLint compiled = GL_FALSE;
      glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
      taken = taken && compiled;
      glAttachShader(program, shader);
      glDeleteShader(shader);
    }
    if (taken && objects.size() > 1) {
      glLinkProgram(program);
      GLint linked = GL_FALSE;
      glGetProgramiv(program, GL_LINK_STATUS, &linked);
      taken = linked != GL_FALSE;
    }
    glDeleteProgram(program);
    return taken;
  }

  // Empty, or the first line of the driver's log.
  static std::string refusal(const std::string& text) {
    const GLuint shader = glCreateShader(GL_FRAGMENT_SHADER);
    const GLchar* string = text.c_str();
    glShaderSource(shader, 1, &string, nullptr);
    glCompileShader(shader);
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    GLchar log[256] = "no log";
    if (!compiled) glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    glDeleteShader(shader);
    return compiled ? "" : std::string(log).substr(0, std::string(log).find('\n'));
  }

 private:
  EGLenum api_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

std::vector<frontend::ShaderObject> asObjects(const std::vector<std::string>& objects) {
  std::vector<frontend::ShaderObject> result;
  for (const std::string& object : objects) result.push_back({{object}, {}});
  return result;
}

std::string read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

// shader_runner's own rule: a shader without #version gets the one that [require] asks for.
std::string withVersion(const std::string& shader, const std::string& version) {
  return shader.find("#version ") != std::string::npos || version.empty() ? shader : version + shader;
}

Test parseShaderTest(const std::string& text) {
  Test test;
  std::string version;
  std::string section;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line[0] == '[') {
      section = line.substr(0, line.find(']') + 1);
      if (section == "[fragment shader]") test.objects.emplace_back();
      continue;
    }
    if (section == "[fragment shader]") test.objects.back() += line + "\n";
    unsigned major = 0;
    unsigned minor = 0;
    if (section != "[require]") continue;
    const bool es = std::sscanf(line.c_str(), "GLSL ES >= %u.%u", &major, &minor) == 2;
    if (!es && std::sscanf(line.c_str(), "GLSL >= %u.%u", &major, &minor) != 2) continue;
    test.es = es;
    version = "#version " + std::to_string(major * 100 + minor) + (es && major >= 3 ? " es\n" : "\n");
  }
  for (std::string& object : test.objects) object = withVersion(object, version);
  return test;
}

Test parseTest(const std::filesystem::path& path) {
  const std::string text = read(path);
  if (path.extension() == ".shader_test") return parseShaderTest(text);
  const bool es = text.find("#version 100") != std::string::npos || text.find(" es\n") != std::string::npos;
  return {{text}, es};
}

std::string directory(const std::filesystem::path& path) {
  bool next = false;
  for (const auto& part : path) {
    if (next) return part.string();
    next = part == "spec";
  }
  return path.parent_path().filename().string();
}

struct Row {
  int compiled = 0;
  int analysed = 0;
  int emitted = 0;
};

}  // namespace

int main(int count, char** arguments) {
  std::vector<std::filesystem::path> files;
  std::ofstream reasons;
  for (int i = 1; i < count; ++i) {
    if (std::string(arguments[i]) == "--reasons" && i + 1 < count) {
      reasons.open(arguments[++i]);
      continue;
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(arguments[i])) {
      const std::string extension = entry.path().extension().string();
      if (extension == ".shader_test" || extension == ".frag") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());

  const Driver desktop(EGL_OPENGL_API);
  const Driver embedded(EGL_OPENGL_ES_API);
  embedded.use();
  const frontend::PreprocessorFacts embedded_facts = embedded.facts();
  desktop.use();
  const frontend::PreprocessorFacts desktop_facts = desktop.facts();

  std::map<std::string, Row> rows;
  std::set<std::vector<std::string>> seen;
  for (const std::filesystem::path& path : files) {
    const Test test = parseTest(path);
    if (test.objects.empty() || !seen.insert(test.objects).second) continue;
    (test.es ? embedded : desktop).use();
    if (!Driver::takes(test.objects)) continue;
    Row& row = rows[directory(path)];
    ++row.compiled;
    const frontend::Analysis analysis = frontend::analyseLinked(
        frontend::Stage::fragment, asObjects(test.objects), test.es ? embedded_facts : desktop_facts);
    if (!analysis.shader) {
      reasons << path.string() << "\t" << analysis.error << "\n" << std::flush;
      continue;
    }
    ++row.analysed;
    const std::string refusal = Driver::refusal(frontend::emit(analysis.shader->tokens));
    if (refusal.empty()) {
      ++row.emitted;
    } else {
      reasons << path.string() << "\tthe driver refuses the emitted text: " << refusal << "\n" << std::flush;
    }
  }

  Row all;
  const auto print = [](const std::string& name, const Row& row) {
    std::printf("| %s | %d | %d | %d | %.2f %% |\n", name.c_str(), row.compiled, row.analysed, row.emitted,
                100.0 * row.emitted / std::max(row.compiled, 1));
  };
  std::printf(
      "| directory | driver compiles | analysed | emitted text compiles | share |\n|---|---|---|---|---|\n");
  for (const auto& [name, row] : rows) {
    print(name, row);
    all.compiled += row.compiled;
    all.analysed += row.analysed;
    all.emitted += row.emitted;
  }
  print("all", all);
}
