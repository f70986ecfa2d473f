#include "session/generated_primitives.h"

#include "instrumenter/origin.h"
#include "session/draw_primitives.h"

namespace shadestep::session {

// Transform feedback lists them primitive by primitive, as the driver makes them.
GeneratedPrimitives::GeneratedPrimitives(Session& session) {
  session.select(Stage::tess_eval);
  session.requireCapturable();
  const frontend::Shader& shader = session.shader();
  each_ = static_cast<std::size_t>(instrumenter::generatedVertices(shader));
  instrumenter::Target target = session.target();
  target.storage_buffers = false;
  instrumenter::Probe start;
  start.statement = shader.functions[static_cast<std::size_t>(shader.main)].body;
  auto instrumented = instrumenter::instrumentSingle(shader, start, target);
  if (const auto* failure = std::get_if<instrumenter::Failure>(&instrumented)) cannotTell(failure->reason);
  const auto& text = std::get<instrumenter::AttachmentShader>(instrumented);
  const Execution executed = session.execute(session.prepare(text));
  check_ = executed.check;

  std::vector<instrumenter::FieldDecoder> decoders;
  for (const instrumenter::Field& field : text.layout.identity) decoders.emplace_back(text.layout, field);
  const auto stride = static_cast<std::size_t>(executed.feedback_words);
  if (decoders.size() != 3 || stride == 0) cannotTell("this needs transform feedback of evaluation shaders");
  for (std::size_t at = 0; at + stride <= executed.feedback.size(); at += stride) {
    std::uint32_t words[3];
    for (std::size_t i = 0; i < 3; ++i) decoders[i].decode(executed.feedback.data() + at, &words[i]);
    vertices_.push_back({static_cast<std::int32_t>(words[0]), words[1], words[2]});
  }
}

std::vector<GeneratedVertex> GeneratedPrimitives::between(const GeneratedVertex& first,
                                                          const GeneratedVertex& last) const {
  std::vector<GeneratedVertex> found;
  for (std::size_t at = 0; at + each_ <= vertices_.size(); at += each_) {
    if (!(vertices_[at] == first) || !(vertices_[at + each_ - 1] == last)) continue;
    if (!found.empty()) cannotTell("two generated primitives begin and end with the same vertices");
    const auto begin = vertices_.begin() + static_cast<std::ptrdiff_t>(at);
    found.assign(begin, begin + static_cast<std::ptrdiff_t>(each_));
  }
  if (found.empty())
    cannotTell("no generated primitive begins and ends with the vertices that the fragment tells");
  return found;
}

}  // namespace shadestep::session
