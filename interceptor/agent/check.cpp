// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/agent/check.h"

#include <algorithm>

#include "wire/channel.h"

namespace shadestep::agent {
namespace {

using guard::Difference;
using guard::Refusal;
using guard::Section;

constexpr int kRedrawsOfWrites = 5;

bool any(const std::vector<Difference>& differences) {
  return std::any_of(differences.begin(), differences.end(),
                     [](const Difference& difference) { return difference.components != 0; });
}

std::size_t roomFor(const std::vector<Section>& sections) {
  return std::max<std::size_t>(guard::totalBytes(sections), 1);
}

// What `read` gives, into `scratch`.
template <class Read>
Refusal readInto(const std::vector<Section>& sections, ScratchMemory& scratch, Read read) {
  std::byte* memory = scratch.reserve(roomFor(sections));
  if (memory == nullptr) return guard::limit("there is not enough memory to compare what two draws leave");
  return read(memory);
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

Refusal DrawTraces::differences(const std::byte* before, ScratchMemory& scratch,
                                std::vector<Difference>& found) {
  const std::vector<Section> sections = this->sections();
  Refusal refusal = readInto(sections, scratch, [&](std::byte* memory) { return read(memory); });
  if (refusal.text.empty()) found = guard::differences(sections, before, scratch.data());
  return refusal;
}

std::vector<Section> StageTraces::sections() const {
  std::vector<Section> sections;
  const std::uint64_t words = feedback_.outputWords();
  if (words > 0) sections.push_back({"the outputs of the " + stage_ + " stage", words * 4, 4, words, true});
  append(sections, memory_.sections());
  return sections;
}

Refusal StageTraces::read(std::byte* destination) {
  feedback_.readOutputs(destination);
  const std::size_t words = feedback_.outputWords();
  const guard::PixelReadGuard reading(facts_);
  return memory_.read(destination + words * 4);
}

Refusal StageTraces::differences(const std::byte* before, ScratchMemory& scratch,
                                 std::vector<Difference>& found) {
  found.clear();
  const std::uint64_t words = feedback_.outputWords();
  if (words > 0) found.push_back(feedback_.outputDifference(before));
  const std::vector<Section> sections = memory_.sections();
  if (sections.empty()) return {};
  Refusal refusal = readInto(sections, scratch, [&](std::byte* memory) {
    const guard::PixelReadGuard reading(facts_);
    return memory_.read(memory);
  });
  if (!refusal.text.empty()) return refusal;
  for (const Difference& difference : guard::differences(sections, before + words * 4, scratch.data()))
    found.push_back(difference);
  return {};
}

Refusal Check::keepReference(Traces& traces) {
  Refusal refusal =
      readInto(traces.sections(), reference_, [&](std::byte* memory) { return traces.read(memory); });
  if (!refusal.text.empty()) dropReference();
  return refusal;
}

Refusal Check::compare(Traces& traces, const Again& again, wire::ExecutedT& executed) {
  const auto other_inputs = [&] {
    executed.compare_reason =
        "two replays of the draw differ in what they leave behind: its inputs are not the same";
    return Refusal{};
  };
  const std::vector<Section> sections = traces.sections();
  if (roomFor(sections) != reference_.size()) return other_inputs();
  std::vector<Difference> differing, unstable(sections.size());
  if (Refusal refusal = traces.differences(reference_.data(), scratch_, differing); !refusal.text.empty())
    return refusal;
  // An open order of writes may come out the same a few times.
  const bool writes_memory =
      std::any_of(sections.begin(), sections.end(), [](const Section& section) { return !section.output; });
  const int redraws = !any(differing) ? 0 : writes_memory ? kRedrawsOfWrites : 1;
  for (int i = 0; i < redraws && !any(unstable); ++i) {
    if (Refusal refusal = again(); !refusal.text.empty()) return refusal;
    if (roomFor(traces.sections()) != reference_.size()) return other_inputs();
    if (Refusal refusal = traces.differences(reference_.data(), scratch_, unstable); !refusal.text.empty())
      return refusal;
  }

  std::string names;
  bool told = true;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (unstable[i].components != 0) {
      names += (names.empty() ? "" : ", ") + sections[i].name;
      executed.unstable += sections[i].components;
      if (!sections[i].output) executed.outside_outputs += sections[i].components;
      continue;
    }
    executed.compared += sections[i].components;
    executed.differing += differing[i].components;
    if (!sections[i].output) executed.outside_outputs += differing[i].components;
    told = told && differing[i].told;
    if (differing[i].by > (executed.largest ? executed.largest->by : -1.0)) {
      executed.largest = std::make_unique<wire::LargestDifferenceT>();
      executed.largest->by = differing[i].by;
      executed.largest->expected = differing[i].before;
      executed.largest->got = differing[i].now;
      executed.largest->where = sections[i].name;
    }
  }
  if (!told) executed.largest.reset();
  if (!names.empty() && executed.differing == 0) {
    executed.compare_reason = "two draws of the program's own shader differ from each other in " + names +
                              ": an open order of writes, a clock or uninitialised variables; the other " +
                              std::to_string(executed.compared) + " components are identical";
  } else if (sections.empty()) {
    executed.compare_reason = wire::kNothingToCompare;
  }
  return {};
}

}  // namespace shadestep::agent
