// What the analysis of a shader costs against glslang's own parse of the same text: CSV on stdout,
// "shape,statements,glslang_ms,analysis_ms,ratio". The two take turns; the median counts.
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "glsl-frontend/shader.h"

namespace {

using namespace shadestep;

constexpr int kRounds = 7;

std::string wrapped(const std::string& globals, const std::string& body) {
  return "#version 330\nout vec4 color;\n" + globals + "void main() {\n  float x = gl_FragCoord.x;\n" + body +
         "  color = vec4(x);\n}\n";
}

std::string expressions(int n) {
  std::string body;
  for (int i = 0; i < n; ++i) body += "  x = x * " + std::to_string(i) + ".0 + sin(x);\n";
  return wrapped("", body);
}

std::string declarations(int n) {
  std::string body = "  float y0 = x;\n";
  for (int i = 1; i < n; ++i)
    body += "  float y" + std::to_string(i) + " = y" + std::to_string(i - 1) + " + 1.0;\n";
  return wrapped("", body);
}

// An if, a loop or a block of its own every third statement.
std::string branches(int n) {
  std::string body;
  for (int i = 0; i + 2 < n; i += 3) {
    const std::string number = std::to_string(i);
    body += i % 2 == 0 ? "  if (x > " + number + ".0) {\n    float z = x;\n    x = z * 0.5;\n  }\n"
                       : "  for (int i = 0; i < 3; ++i) {\n    x += float(i);\n  }\n";
  }
  return wrapped("", body);
}

// Functions of ten statements, each calling the one before.
std::string functions(int n) {
  std::string globals = "float g;\nfloat f0(float a) { return a; }\n";
  int last = 0;
  for (int i = 0; i + 9 < n; i += 10) {
    globals +=
        "float f" + std::to_string(last + 1) + "(float a) {\n  float b = f" + std::to_string(last) + "(a);\n";
    for (int j = 0; j < 8; ++j) globals += "  b = b + a * " + std::to_string(j) + ".0;\n";
    globals += "  return b;\n}\n";
    ++last;
  }
  return wrapped(globals, "  x = f" + std::to_string(last) + "(x);\n");
}

// Of this thread's processor time: what else the machine does stays out.
double milliseconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

bool measure(const char* shape, int statements, const std::string& text) {
  std::vector<double> parse, analysis;
  for (int round = 0; round < kRounds; ++round) {
    double start = milliseconds();
    glslang::TShader shader(EShLangFragment);
    const char* string = text.c_str();
    shader.setStrings(&string, 1);
    if (!shader.parse(GetDefaultResources(), 110, false, EShMsgSuppressWarnings)) return false;
    parse.push_back(milliseconds() - start);
    start = milliseconds();
    if (!frontend::analyse(frontend::Stage::fragment, {text}, {}).shader) return false;
    analysis.push_back(milliseconds() - start);
  }
  const double bare = median(parse);
  const double ours = median(analysis);
  std::printf("%s,%d,%.3f,%.3f,%.2f\n", shape, statements, bare, ours, ours / bare);
  return true;
}

}  // namespace

int main() {
  glslang::InitializeProcess();
  std::printf("shape,statements,glslang_ms,analysis_ms,ratio\n");
  bool all = true;
  for (const int n : {10, 100, 1000, 10000}) {
    all = measure("expressions", n, expressions(n)) && all;
    all = measure("declarations", n, declarations(n)) && all;
    all = measure("branches", n, branches(n)) && all;
    all = measure("functions", n, functions(n)) && all;
  }
  return all ? 0 : 1;
}
