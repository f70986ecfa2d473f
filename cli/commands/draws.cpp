// shadestep draws: what a program draws, and whether its shaders can be debugged.
#include <cstdio>
#include <iostream>

#include "cli/common.h"

namespace shadestep::cli {
namespace {

struct Options {
  std::string frames;
};

std::string joined(const frontend::ShaderObject& object) {
  std::string text;
  for (const std::string& string : object.strings) text += string;
  return text;
}

// FNV-1a over the strings, and those that they may include: tells sources apart, no more.
std::string hashOf(const std::vector<frontend::ShaderObject>& objects) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&hash](const std::string& text) {
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  };
  for (const frontend::ShaderObject& object : objects) {
    add(joined(object));
    for (const auto& [name, string] : object.includes.named) add(name + string);
  }
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

std::size_t linesOf(const std::vector<frontend::ShaderObject>& objects) {
  std::size_t lines = 0;
  for (const frontend::ShaderObject& object : objects) {
    const std::string text = joined(object);
    for (const char c : text) lines += c == '\n' ? 1 : 0;
    lines += text.empty() || text.back() == '\n' ? 0 : 1;
  }
  return lines;
}

// Why this stage cannot be debugged; empty if it can.
std::string reasonAgainst(session::Session& session, const session::StageFacts& stage) {
  if (!stage.reason.empty()) return stage.reason;
  try {
    session.select(stage.stage);
    session.requireCapturable();
  } catch (const session::Error& error) {
    return error.what();
  }
  return {};
}

Json describeDraw(session::Session& session, const session::DrawStop& stop) {
  const session::DrawFacts& facts = session.facts();
  Json draw;
  draw["draw"] = stop.draw;
  draw["call"] = stop.call;
  draw["mode"] = stop.mode == 0xffffffffu ? Json(nullptr) : Json(session::primitiveModeName(stop.mode));
  draw["count"] = stop.count < 0 ? Json(nullptr) : Json(stop.count);
  draw["instances"] = stop.instances < 0 ? Json(nullptr) : Json(stop.instances);
  draw["program"] = facts.program;
  draw["framebuffer"] = facts.framebuffer;
  draw["viewport"] = {facts.viewport[0], facts.viewport[1], facts.viewport[2], facts.viewport[3]};
  Json stages = Json::object();
  for (const session::StageFacts& stage : facts.stages) {
    const std::string reason = reasonAgainst(session, stage);
    Json one;
    one["debuggable"] = reason.empty();
    one["reason"] = reason.empty() ? Json(nullptr) : Json(reason);
    one["lines"] = linesOf(stage.objects);
    one["hash"] = hashOf(stage.objects);
    stages[session::stageName(stage.stage)] = std::move(one);
  }
  draw["stages"] = std::move(stages);
  if (!facts.program_reason.empty()) draw["reason"] = facts.program_reason;
  return draw;
}

void printDraw(std::uint64_t frame, const Json& draw) {
  std::cout << "frame " << frame << "  draw " << draw["draw"] << "  " << draw["call"].get<std::string>();
  if (!draw["mode"].is_null()) std::cout << "  " << draw["mode"].get<std::string>();
  if (!draw["count"].is_null()) std::cout << "  " << draw["count"] << " vertices";
  if (draw["instances"].is_null())
    std::cout << "  vertices and instances as a buffer says";
  else if (draw["instances"] != 1)
    std::cout << " x " << draw["instances"];
  std::cout << "  program " << draw["program"] << "  framebuffer " << draw["framebuffer"] << "  viewport "
            << draw["viewport"].dump() << "\n";
  if (draw.contains("reason")) std::cout << "    " << draw["reason"].get<std::string>() << "\n";
  for (const auto& [name, stage] : draw["stages"].items()) {
    std::cout << "    " << name << ": " << stage["lines"] << " lines, ";
    if (stage["debuggable"].get<bool>()) {
      std::cout << "can be debugged\n";
    } else {
      std::cout << "cannot be debugged: " << stage["reason"].get<std::string>() << "\n";
    }
  }
}

int run(const Common& common, const Options& options) {
  const auto [first, last] = frameRange(common, options.frames);
  session::Session session(common.launchOptions());
  Json frames = Json::array();
  const auto frameEntry = [&](std::uint64_t number) -> Json& {
    if (frames.empty() || frames.back()["frame"] != number) {
      frames.push_back({{"frame", number}, {"draws", Json::array()}});
    }
    return frames.back();
  };
  const auto counts = session.forEachDraw(first, last, [&](const session::DrawStop& stop) {
    Json draw = describeDraw(session, stop);
    if (!common.json) printDraw(stop.frame, draw);
    frameEntry(stop.frame)["draws"].push_back(std::move(draw));
  });
  if (counts.empty() && frames.empty()) {
    throw session::Error(session::Outcome::nothing_matches,
                         "frame " + std::to_string(first) + " is not there");
  }
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) {
      frameEntry(first + i);
      if (!common.json) std::cout << "frame " << first + i << "  no draws\n";
    }
  }
  if (common.json) print({{"frames", frames}});
  return 0;
}

}  // namespace

void addDraws(CLI::App& app, Common& common, Action& action) {
  CLI::App* command = app.add_subcommand("draws", "list the draws of one or more frames");
  auto options = std::make_shared<Options>();
  addCommonOptions(*command, common);
  addFrameOptions(*command, common, options->frames);
  command->callback(
      [&common, &action, options] { action = [&common, options] { return run(common, *options); }; });
}

}  // namespace shadestep::cli
