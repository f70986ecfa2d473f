#include "cli/fragment_options.h"

#include <utility>

namespace shadestep::cli {
namespace {

using Switch = session::FragmentChoice::Switch;

Switch switchOf(const std::string& text) {
  return text == "on" ? Switch::on : text == "off" ? Switch::off : Switch::keep;
}

}  // namespace

session::FragmentChoice FragmentOptions::choice() const {
  session::FragmentChoice choice;
  choice.layer = layer;
  choice.sample = sample;
  choice.alpha_test = switchOf(alpha_test);
  choice.depth_test = switchOf(depth_test);
  choice.stencil_test = switchOf(stencil_test);
  choice.blend = switchOf(blend);
  choice.clear_buffers = buffers == "clear";
  return choice;
}

void addFragmentOptions(CLI::App& command, FragmentOptions& options) {
  const std::string group = "Which fragments";
  const auto number = [&](const char* name, int& value, const char* text) {
    command.add_option(name, value, text)->type_name("N")->group(group);
  };
  const auto one_of = [&](const char* name, std::string& value, const char* text, const char* a,
                          const char* b, const char* c) {
    std::vector<std::string> allowed = {a, b};
    if (c != nullptr) allowed.emplace_back(c);
    command.add_option(name, value, text)->check(CLI::IsMember(allowed))->group(group);
  };
  number("--layer", options.layer, "of a layered target (array, cube map, volume); default 0");
  number("--sample", options.sample,
         "of a multisampled target: the fragment that this sample holds; default 0");
  one_of("--alpha-test", options.alpha_test, "as the program has it, or forced", "keep", "on", "off");
  one_of("--depth-test", options.depth_test, "the same", "keep", "on", "off");
  one_of("--stencil-test", options.stencil_test, "the same", "keep", "on", "off");
  one_of("--blend", options.blend, "the same, for all draw buffers", "keep", "on", "off");
  one_of("--buffers", options.buffers,
         "replays start from a copy of the program's buffers, or from its clear values", "copy", "clear",
         nullptr);
}

void choose(session::Session& session, const FragmentOptions& options) {
  session.choose(options.choice());
}

std::string describe(const FragmentOptions& options) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (options.layer != 0) add("layer " + std::to_string(options.layer));
  if (options.sample != 0) add("sample " + std::to_string(options.sample));
  const std::pair<const char*, const std::string&> switches[] = {{"alpha test ", options.alpha_test},
                                                                 {"depth test ", options.depth_test},
                                                                 {"stencil test ", options.stencil_test},
                                                                 {"blending ", options.blend}};
  for (const auto& [name, value] : switches) {
    if (value != "keep") add(name + value);
  }
  if (options.buffers == "clear") add("buffers cleared before");
  return text.empty() ? "" : "with " + text + ":";
}

Json toJson(const FragmentOptions& options) {
  if (describe(options).empty()) return nullptr;
  return {{"layer", options.layer},
          {"sample", options.sample},
          {"alpha_test", options.alpha_test},
          {"depth_test", options.depth_test},
          {"stencil_test", options.stencil_test},
          {"blend", options.blend},
          {"buffers", options.buffers}};
}

}  // namespace shadestep::cli
