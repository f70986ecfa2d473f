#include "session/hit_values.h"

#include <algorithm>

#include "session/recorded_visits.h"
#include "session/values.h"

namespace shadestep::session {
namespace {

using frontend::Shader;

// The part of a variable's value that an expression like "a", "a.x" or "m[1]" names; `expression` is the
// watch's.
instrumenter::Value partOf(const Shader& shader, const frontend::Watch& watch,
                           const instrumenter::Value& whole) {
  const std::string& name = shader.variables[static_cast<std::size_t>(watch.variable)].name;
  std::string access = watch.expression.substr(std::min(name.size(), watch.expression.size()));
  std::erase(access, ' ');
  instrumenter::Value part{watch.type, {}};
  std::size_t word = 0;
  for (const frontend::Component& component : frontend::components(whole.type)) {
    const auto words = static_cast<std::size_t>(wordsPerComponent(component.basic));
    const bool inside = component.access.starts_with(access) &&
                        (component.access.size() == access.size() || access.empty() ||
                         component.access[access.size()] == '.' || component.access[access.size()] == '[');
    if (inside) {
      part.words.insert(part.words.end(), whole.words.begin() + static_cast<std::ptrdiff_t>(word),
                        whole.words.begin() + static_cast<std::ptrdiff_t>(word + words));
    }
    word += words;
  }
  if (part.words.empty()) {
    throw Error(Outcome::cannot_debug, "'" + watch.expression +
                                           "' cannot be taken out of a recording; print '" + name +
                                           "', or one component of it");
  }
  return part;
}

}  // namespace

instrumenter::Value recordedValue(const Shader& shader, const LastVisit& visit,
                                  const frontend::Watch& watch) {
  if (watch.variable == frontend::kNone) {
    throw Error(
        Outcome::cannot_debug,
        "'" + watch.expression +
            "' is an expression, and a recording holds variables; print those that it reads, or leave "
            "--hit or --plan recording out");
  }
  const auto known = visit.known.find(watch.variable);
  if (known != visit.known.end()) return partOf(shader, watch, known->second.value);
  throw Error(Outcome::cannot_debug,
              "'" + watch.expression +
                  "' is not in the recording, which holds what the shader itself sets; "
                  "leave --hit or --plan recording out to see it");
}

HitValues valuesOfHit(Session& session, int x, int y, int hit, const PlaceSelection& place,
                      const std::vector<std::string>& names) {
  const Shader& shader = session.shader(Stage::fragment);
  const instrumenter::Probe probe = probeAt(shader, place);
  if (!probe.call_path.empty()) {
    throw Error(Outcome::cannot_debug,
                "--call and --hit do not go together; 'debug --pixel --hit' alone shows every call");
  }
  const std::vector<frontend::Watch> watches = watchesAt(shader, probe, names);
  const Session::Recorded recorded = recordPixel(session, x, y);
  HitValues result;
  result.hits = hitsOn(recorded, x, y);
  result.hit = pickHit(result.hits, x, y, hit);
  result.check = recorded.execution.check;
  const auto visit = lastVisit(shader, recorded.layout,
                               recorded.recording.threads[static_cast<std::size_t>(result.hit)], probe);
  result.reached = visit.has_value();
  for (const frontend::Watch& watch : watches) {
    if (!visit) break;
    result.values.push_back({watch.expression, recordedValue(shader, *visit, watch)});
  }
  return result;
}

}  // namespace shadestep::session
