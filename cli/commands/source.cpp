// shadestep source: the selected shader, numbered as all commands number it.
#include <cstdio>
#include <iostream>

#include "cli/common.h"

namespace shadestep::cli {
namespace {

using frontend::StatementKind;

// What a site is called on the command line; null for statements that are no places to stop at.
const char* siteKind(StatementKind kind) {
  switch (kind) {
    case StatementKind::expression:
      return "expression";
    case StatementKind::declaration:
      return "declaration";
    case StatementKind::if_:
      return "if";
    case StatementKind::for_:
      return "for";
    case StatementKind::while_:
      return "while";
    case StatementKind::do_while:
      return "do-while";
    case StatementKind::switch_:
      return "switch";
    case StatementKind::return_:
      return "return";
    case StatementKind::discard:
      return "discard";
    case StatementKind::break_:
      return "break";
    case StatementKind::continue_:
      return "continue";
    case StatementKind::opaque:
      return "opaque";
    case StatementKind::block:
    case StatementKind::case_label:
      return nullptr;
  }
  return nullptr;
}

int run(const Common& common) {
  session::Session session(common.launchOptions());
  session.runTo(common.frame, common.draw);
  const frontend::Shader& shader = session.shader(selectedStage(common));

  Json sites = Json::array();
  std::vector<bool> has_site(shader.lines.size() + 1, false);
  for (const frontend::Statement& statement : shader.statements) {
    const char* kind = siteKind(statement.kind);
    if (kind == nullptr) continue;
    const std::string& function = shader.functions[static_cast<std::size_t>(statement.function)].name;
    sites.push_back({{"line", statement.place.line},
                     {"column", statement.place.column},
                     {"kind", kind},
                     {"function", function}});
    const auto line = static_cast<std::size_t>(statement.place.line);
    if (line < has_site.size()) has_site[line] = true;
  }
  if (common.json) {
    Json document;
    document["stage"] = common.stage;
    document["version"] = shader.version;
    document["lines"] = shader.lines;
    document["objects"] = shader.object_lines;
    document["included"] = Json::array();
    for (const frontend::IncludedString& string : shader.included)
      document["included"].push_back({{"line", string.first_line}, {"name", string.name}});
    document["sites"] = std::move(sites);
    print(document);
    return 0;
  }
  std::size_t object = 0;
  auto included = shader.included.begin();
  for (std::size_t i = 0; i < shader.lines.size(); ++i) {
    const bool object_starts =
        object < shader.object_lines.size() && static_cast<std::size_t>(shader.object_lines[object]) == i + 1;
    if (object_starts && ++object > 0 && shader.object_lines.size() > 1) {
      std::printf("      -- shader object %zu of %zu\n", object, shader.object_lines.size());
    }
    if (included != shader.included.end() && static_cast<std::size_t>(included->first_line) == i + 1) {
      std::printf("      -- included string %s\n", included++->name.c_str());
    }
    std::printf("%5zu %c %s\n", i + 1, has_site[i + 1] ? '*' : ' ', shader.lines[i].c_str());
  }
  return 0;
}

}  // namespace

void addSource(CLI::App& app, Common& common, Action& action) {
  CLI::App* command = app.add_subcommand("source", "print the selected shader; * marks lines to stop at");
  addCommonOptions(*command, common);
  addSelectionOptions(*command, common);
  command->callback([&common, &action] { action = [&common] { return run(common); }; });
}

}  // namespace shadestep::cli
