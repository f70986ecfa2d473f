// layout(...): what glslang may be too strict about.
#include <algorithm>
#include <array>

#include "glsl-frontend/skeleton_parser.h"

namespace shadestep::frontend::skeleton {

namespace {

// Says where something lies and not what it is. Drivers and extensions differ in what may lie where.
bool isAboutPlaces(std::string_view id) {
  static constexpr std::array<std::string_view, 12> kIds = {
      "location",         "component",     "index",          "binding",
      "offset",           "align",         "noncoherent",    "xfb_buffer",
      "bindless_sampler", "bound_sampler", "bindless_image", "bound_image"};
  return std::find(kIds.begin(), kIds.end(), id) != kIds.end();
}

}  // namespace

// At the '(' of layout(...); leaves it behind.
void Parser::layoutIds() {
  const Position layout = at_ - 1;
  const Position end = at_ + closing(0);
  std::vector<TokenRange> places, kept;
  for (++at_; at_ <= end; ++at_) {
    const Position first = at_;
    const bool place = isAboutPlaces(text());
    for (int depth = 0; at_ < end && (depth > 0 || !is(",")); ++at_) depth += is("(") ? 1 : is(")") ? -1 : 0;
    (place ? places : kept).push_back(range(first, at_ - 1));
  }
  if (places.empty()) return;
  for (TokenIndex i = tokenAt(layout); i <= tokenAt(end); ++i) out_.relaxed_as[i] = "";
  if (kept.empty()) return;
  out_.relaxed_as.erase(tokenAt(layout));
  out_.relaxed_as.erase(tokenAt(layout + 1));
  out_.relaxed_as.erase(tokenAt(end));
  for (const TokenRange& id : kept) {
    for (TokenIndex i = id.first; i <= id.last; ++i) out_.relaxed_as.erase(i);
    if (id != kept.back()) out_.relaxed_as[id.last] = tokens_[static_cast<std::size_t>(id.last)].text + ",";
  }
}

bool Parser::isImage(const std::string& type) {
  const std::size_t start = type.find("image");
  return start == 0 || (start == 1 && (type[0] == 'i' || type[0] == 'u'));
}

// glslang wants an argument to have its parameter's format, and lets no parameter have one.
void Parser::relaxImageFormats() {
  for (const auto& [type, layout] : image_layouts_) {
    if (image_parameters_.count(type) == 0) continue;
    for (TokenIndex i = layout.first; i <= layout.last; ++i) out_.relaxed_as[i] = "";
  }
}

}  // namespace shadestep::frontend::skeleton
