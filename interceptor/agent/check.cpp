// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/agent/check.h"

#include <algorithm>

namespace shadestep::agent {
namespace {

using guard::Refusal;
using guard::Section;

bool any(const std::vector<std::uint64_t>& counts) {
  return std::any_of(counts.begin(), counts.end(), [](std::uint64_t count) { return count != 0; });
}

Refusal readInto(Traces& traces, ScratchMemory& into) {
  std::byte* memory = into.reserve(std::max<std::size_t>(guard::totalBytes(traces.sections()), 1));
  if (memory == nullptr) return guard::limit("there is not enough memory to compare what two draws leave");
  return traces.read(memory);
}

void append(std::vector<Section>& sections, std::vector<Section> more) {
  for (Section& section : more) sections.push_back(std::move(section));
}

}  // namespace

std::vector<Section> DrawTraces::sections() const {
  std::vector<Section> sections = shadow_.sections();
  append(sections, memory_.sections());
  return sections;
}

Refusal DrawTraces::read(std::byte* destination) {
  const guard::PixelReadGuard reading(facts_);
  shadow_.readOriginals(destination);
  return memory_.read(destination + guard::totalBytes(shadow_.sections()));
}

std::vector<Section> StageTraces::sections() const {
  std::vector<Section> sections;
  const std::uint64_t words = feedback_.outputWords();
  if (words > 0) sections.push_back({"the outputs of the " + stage_ + " stage", words * 4, 4, words});
  append(sections, memory_.sections());
  return sections;
}

Refusal StageTraces::read(std::byte* destination) {
  feedback_.readOutputs(destination);
  const std::size_t words = feedback_.outputWords();
  const guard::PixelReadGuard reading(facts_);
  return memory_.read(destination + words * 4);
}

Refusal Check::keepReference(Traces& traces) {
  Refusal refusal = readInto(traces, reference_);
  if (!refusal.text.empty()) dropReference();
  return refusal;
}

Refusal Check::compare(Traces& traces, const Again& again, wire::ExecutedT& executed) {
  const std::vector<Section> sections = traces.sections();
  if (Refusal refusal = readInto(traces, drawn_); !refusal.text.empty()) return refusal;
  if (drawn_.size() != reference_.size()) {
    executed.compare_reason =
        "two replays of the draw differ in what they leave behind: its inputs are not the same";
    return {};
  }
  const std::vector<std::uint64_t> differing = guard::differences(sections, reference_.data(), drawn_.data());
  std::vector<std::uint64_t> unstable(sections.size(), 0);
  if (any(differing)) {
    if (Refusal refusal = again(); !refusal.text.empty()) return refusal;
    ScratchMemory second;
    if (Refusal refusal = readInto(traces, second); !refusal.text.empty()) return refusal;
    unstable = guard::differences(sections, reference_.data(), second.data());
  }

  std::string names;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (unstable[i] != 0) {
      names += (names.empty() ? "" : ", ") + sections[i].name;
      executed.unstable += sections[i].components;
      if (!sections[i].color) executed.outside_colors += sections[i].components;
      continue;
    }
    executed.compared += sections[i].components;
    executed.differing += differing[i];
    if (!sections[i].color) executed.outside_colors += differing[i];
  }
  if (!names.empty() && executed.differing == 0) {
    executed.compare_reason = "two draws of the program's own shader differ from each other in " + names +
                              ": an open order of writes, a clock or uninitialised variables; the other " +
                              std::to_string(executed.compared) + " components are identical";
  } else if (sections.empty()) {
    executed.compare_reason = "it writes nothing that could be compared";
  }
  return {};
}

}  // namespace shadestep::agent
