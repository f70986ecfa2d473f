// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/agent/check.h"

#include <algorithm>

namespace shadestep::agent {
namespace {

using guard::Refusal;
using guard::Section;

std::vector<Section> allSections(const capture::Shadow& shadow, const guard::WritableMemory& memory) {
  std::vector<Section> sections = shadow.sections();
  for (Section& section : memory.sections()) sections.push_back(std::move(section));
  return sections;
}

bool any(const std::vector<std::uint64_t>& counts) {
  return std::any_of(counts.begin(), counts.end(), [](std::uint64_t count) { return count != 0; });
}

}  // namespace

// The guard of pixel reads lives here and not around compare(): what it sets may change what a draw draws.
Refusal Check::read(capture::Shadow& shadow, const guard::WritableMemory& memory,
                    wire::SharedMemory& into) const {
  const std::size_t bytes = guard::totalBytes(allSections(shadow, memory));
  into = wire::SharedMemory::create("shadestep-outputs", std::max<std::size_t>(bytes, 1));
  if (!into) return guard::limit("there is not enough shared memory to compare what two draws leave");
  const guard::PixelReadGuard reading(facts_);
  shadow.readOriginals(into.data());
  return memory.read(into.data() + guard::totalBytes(shadow.sections()));
}

Refusal Check::keepReference(capture::Shadow& shadow, const guard::WritableMemory& memory) {
  Refusal refusal = read(shadow, memory, reference_);
  if (!refusal.text.empty()) dropReference();
  return refusal;
}

Refusal Check::compare(capture::Shadow& shadow, const guard::WritableMemory& memory, const Draw& again,
                       wire::ExecutedT& executed) const {
  const std::vector<Section> sections = allSections(shadow, memory);
  wire::SharedMemory drawn;
  if (Refusal refusal = read(shadow, memory, drawn); !refusal.text.empty()) return refusal;
  const std::vector<std::uint64_t> differing = guard::differences(sections, reference_.data(), drawn.data());
  std::vector<std::uint64_t> unstable(sections.size(), 0);
  if (any(differing)) {
    if (Refusal refusal = again(); !refusal.text.empty()) return refusal;
    wire::SharedMemory second;
    if (Refusal refusal = read(shadow, memory, second); !refusal.text.empty()) return refusal;
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
    executed.compare_reason = "the draw writes to no buffer";
  }
  return {};
}

}  // namespace shadestep::agent
