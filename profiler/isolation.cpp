#include "profiler/isolation.h"

#include <algorithm>

#include "profiler/profile_parts.h"

namespace shadestep::profiler {

Isolation::Isolation(session::Session& session, const ProfileOptions& options) : session_(session) {
  const auto result =
      instrumenter::instrumentIsolate(session.shader(session::Stage::fragment), session.target());
  const instrumenter::IsolatedShader& shader = orThrow(result);
  captureInputs(shader.inputs, options);
  isolated_ = session.prepareCovering(shader.text, shader.vertex_text);
  baseline_ = session.prepareCovering(shader.baseline_text, shader.vertex_text);
}

std::vector<double> Isolation::time(std::size_t pixel, int size, int repeats) {
  return draw(isolated_, pixel, size, repeats);
}

std::vector<double> Isolation::timeBaseline(std::size_t pixel, int size, int repeats) {
  return draw(baseline_, pixel, size, repeats);
}

void Isolation::captureInputs(const std::vector<instrumenter::IsolatedInput>& wanted,
                              const ProfileOptions& options) {
  const frontend::Shader& shader = session_.shader(session::Stage::fragment);
  instrumenter::Probe probe = instrumenter::inputsProbe(shader);
  // As many passes as the draw buffers demand; the first also says which pixels have a thread.
  do {
    const auto result = instrumenter::instrumentSingle(shader, probe, session_.target());
    const session::Captured captured = session_.capture(orThrow(result));
    check_.merge(captured.execution.check);
    if (covered_.cost.empty()) covered_ = coveredPixels(captured, options);
    keep(captured, wanted);
    const std::size_t before = probe.watches.size();
    std::erase_if(probe.watches, [&](const frontend::Watch& watch) {
      return std::any_of(captured.layout.fields.begin(), captured.layout.fields.end(),
                         [&](const instrumenter::Field& field) { return field.name == watch.expression; });
    });
    if (probe.watches.size() == before && before > 0)
      throw session::Error(session::Outcome::cannot_debug,
                           "the driver's draw buffers have no room for the shader's input '" +
                               probe.watches.front().expression + "'; use --method count");
  } while (!probe.watches.empty());
}

void Isolation::keep(const session::Captured& captured,
                     const std::vector<instrumenter::IsolatedInput>& wanted) {
  for (const instrumenter::Field& field : captured.layout.fields)
    for (const instrumenter::IsolatedInput& input : wanted) {
      if (input.input != field.name) continue;
      Input kept{{input.uniform, session::glUniformType(input.type), {}}, {}, 0};
      if (kept.uniform.gl_type == 0)
        throw session::Error(
            session::Outcome::cannot_debug,
            "the shader's input '" + input.input + "' is a " + frontend::glslName(input.type) +
                ", which cannot be handed over as one uniform; use --method clock or --method count");
      kept.words_per_pixel = static_cast<std::size_t>(frontend::wordCount(field.type));
      kept.words.reserve(covered_.cost.size() * kept.words_per_pixel);
      for (int y = 0; y < covered_.height; ++y)
        for (int x = 0; x < covered_.width; ++x) {
          const auto value = instrumenter::decode(captured.layout, field, captured.threads.at(x, y));
          kept.words.insert(kept.words.end(), value.words.begin(), value.words.end());
        }
      inputs_.push_back(std::move(kept));
    }
}

SameOutput Isolation::compareOutputs(const std::vector<std::size_t>& pixels) {
  const session::Prepared original = session_.prepareOriginal();
  session::ExecuteOptions whole;
  whole.compare = false;
  whole.read_outputs = true;
  const std::vector<session::ColorOutput> expected = session_.execute(original, whole).outputs;
  SameOutput result;
  for (const std::size_t pixel : pixels) {
    session::ExecuteOptions one = optionsFor(pixel, 1);
    one.read_outputs = true;
    const std::vector<session::ColorOutput> found = session_.execute(isolated_, one).outputs;
    bool same = found.size() >= expected.size();
    for (std::size_t i = 0; same && i < expected.size(); ++i)
      same = std::equal(found[i].words.begin(), found[i].words.begin() + 4,
                        expected[i].words.begin() + static_cast<std::ptrdiff_t>(4 * pixel));
    ++result.tried;
    result.same += same ? 1 : 0;
  }
  return result;
}

session::ExecuteOptions Isolation::optionsFor(std::size_t pixel, int size) const {
  session::ExecuteOptions execute;
  execute.compare = false;
  execute.read_captures = false;
  execute.covering_size = size;
  for (const Input& input : inputs_) {
    const auto first = input.words.begin() + static_cast<std::ptrdiff_t>(pixel * input.words_per_pixel);
    execute.uniforms.push_back(input.uniform);
    execute.uniforms.back().words.assign(first, first + static_cast<std::ptrdiff_t>(input.words_per_pixel));
  }
  return execute;
}

std::vector<double> Isolation::draw(const session::Prepared& prepared, std::size_t pixel, int size,
                                    int repeats) {
  session::ExecuteOptions execute = optionsFor(pixel, size);
  execute.repeats = repeats;
  std::vector<double> nanoseconds;
  for (const std::chrono::nanoseconds time : session_.execute(prepared, execute).times)
    nanoseconds.push_back(static_cast<double>(time.count()));
  return nanoseconds;
}

}  // namespace shadestep::profiler
