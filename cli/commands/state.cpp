// shadestep state: the uniforms, textures, buffers and the context's state that a draw reads.
#include "cli/commands/state.h"

#include <fnmatch.h>

#include <algorithm>
#include <iostream>

namespace shadestep::cli {
namespace {

constexpr std::string_view kUniform = "uniform ";

struct DrawState {
  std::vector<std::pair<std::string, std::string>> uniforms, context;
  std::vector<session::ShaderTexture> textures;
  std::string no_textures;  // why there are none to tell of ("" if they are told)
  std::vector<session::BoundBuffer> buffers;
};

DrawState stateOf(session::Session& session, const StateOptions& options) {
  DrawState state;
  const std::vector<std::string> wanted = splitList(options.filter);
  const auto matches = [&](const std::string& name) {
    return std::any_of(wanted.begin(), wanted.end(),
                       [&](const std::string& glob) { return fnmatch(glob.c_str(), name.c_str(), 0) == 0; });
  };
  for (auto& [name, value] : session.glState()) {
    if (name.starts_with(kUniform))
      state.uniforms.emplace_back(name.substr(kUniform.size()), value);
    else if (matches(name))
      state.context.emplace_back(name, value);
  }
  try {
    state.textures = session::shaderTextures(session);
  } catch (const session::Error& error) {
    if (error.outcome() == session::Outcome::ended) throw;
    state.no_textures = error.what();
  }
  state.buffers = session.buffers();
  return state;
}

Json asJson(const std::vector<std::pair<std::string, std::string>>& values) {
  Json json = Json::object();
  for (const auto& [name, value] : values) json[name] = value;
  return json;
}

Json asJson(const DrawState& state) {
  Json document;
  document["uniforms"] = asJson(state.uniforms);
  document["textures"] = Json::array();
  for (const session::ShaderTexture& texture : state.textures)
    document["textures"].push_back(cli::asJson(texture));
  document["no_textures"] = state.no_textures.empty() ? Json(nullptr) : Json(state.no_textures);
  document["buffers"] = Json::array();
  for (const session::BoundBuffer& buffer : state.buffers) document["buffers"].push_back(cli::asJson(buffer));
  document["context"] = asJson(state.context);
  return document;
}

void printSection(const std::string& title, const std::vector<std::string>& lines, const std::string& none) {
  std::cout << title << "\n";
  for (const std::string& line : lines) std::cout << "  " << line << "\n";
  if (lines.empty()) std::cout << "  " << none << "\n";
}

template <class Items, class Text>
std::vector<std::string> lines(const Items& items, Text text) {
  std::vector<std::string> result;
  for (const auto& item : items) result.push_back(text(item));
  return result;
}

void printText(const DrawState& state, bool filtered) {
  const auto pair = [](const auto& one) { return one.first + " = " + one.second; };
  printSection("uniforms", lines(state.uniforms, pair), "none");
  printSection("textures of the fragment shader",
               lines(state.textures, [](const session::ShaderTexture& one) { return cli::asText(one); }),
               state.no_textures.empty() ? "none" : state.no_textures);
  printSection("buffers",
               lines(state.buffers, [](const session::BoundBuffer& one) { return cli::asText(one); }),
               "none");
  if (filtered) printSection("context", lines(state.context, pair), "nothing has such a name");
}

int run(const Common& common, const StateOptions& options) {
  if (!options.texture.empty() && !options.buffer.empty())
    throw session::Error(session::Outcome::usage,
                         "--texture and --buffer are two questions; ask one of them");
  if (options.texture.empty() && options.buffer.empty() && !(options.csv.empty() && options.image.empty()))
    throw session::Error(session::Outcome::usage, "--csv and --image need --texture NAME or --buffer NAME");
  session::Session session(common.launchOptions());
  session.runTo(common.frame, common.draw);
  if (!options.texture.empty()) return showTexture(session, common, options);
  if (!options.buffer.empty()) return showBuffer(session, common, options);
  const DrawState state = stateOf(session, options);
  if (common.json)
    print(asJson(state));
  else
    printText(state, !options.filter.empty());
  return 0;
}

}  // namespace

void addState(CLI::App& app, Common& common, Action& action) {
  CLI::App* command = app.add_subcommand("state", "the uniforms, textures and buffers that a draw reads");
  auto options = std::make_shared<StateOptions>();
  addCommonOptions(*command, common);
  command->add_option("--frame", common.frame, "the frame, 0-based")->type_name("N");
  command->add_option("--draw", common.draw, "the draw in its frame, 0-based")->type_name("N");
  command->add_option("--filter", options->filter, "also the context's state of such names: *BLEND*,*DEPTH*")
      ->type_name("GLOB[,...]");
  command
      ->add_option("--texture", options->texture, "the texels that this sampler of the fragment shader reads")
      ->type_name("NAME");
  command->add_option("--level", options->level, "which mipmap level of it; the base level")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--slice", options->slice, "which slice, layer, face or sample of it; 0")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--buffer", options->buffer,
                   "what stands in the buffer of this block or vertex attribute, or in that of the 'indices'")
      ->type_name("NAME");
  command->add_option("--image", options->image, "the texels as a picture, .png or .exr")->type_name("F");
  command->add_option("--csv", options->csv, "the texels, or what stands in the buffer, as a table")
      ->type_name("F");
  command->callback(
      [&common, &action, options] { action = [&common, options] { return run(common, *options); }; });
}

}  // namespace shadestep::cli
