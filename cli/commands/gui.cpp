// shadestep gui: opens the window, a program of its own beside this one: it links Qt, and this does not.
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "cli/common.h"

namespace shadestep::cli {
namespace {

namespace fs = std::filesystem;

// The window is no program under debug, whatever this one was started under.
void withoutInterceptor() {
  const char* const preloaded = std::getenv("LD_PRELOAD");
  if (preloaded == nullptr) return;
  std::string others;
  std::string entry;
  for (const char* at = preloaded;; ++at) {
    if (*at != '\0' && *at != ':' && *at != ' ') {
      entry += *at;
      continue;
    }
    if (!entry.empty() && !entry.ends_with("libshadestep-gl.so"))
      others += (others.empty() ? "" : ":") + entry;
    entry.clear();
    if (*at == '\0') break;
  }
  if (others.empty()) {
    unsetenv("LD_PRELOAD");
  } else {
    setenv("LD_PRELOAD", others.c_str(), 1);
  }
}

int run(const Common& common, const std::string& session_file) {
  std::error_code error;
  const fs::path window = fs::read_symlink("/proc/self/exe", error).parent_path() / "shadestep-gui";
  if (!fs::exists(window)) {
    throw session::Error(
        session::Outcome::failed,
        "the window is not beside this executable; build the target shadestep-gui, which needs Qt 6 "
        "and QScintilla ('scripts/setup' installs them)");
  }
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr &&
      std::getenv("QT_QPA_PLATFORM") == nullptr) {
    throw session::Error(
        session::Outcome::failed,
        "there is no display to open a window on; 'xvfb-run -a shadestep gui ...' makes one");
  }
  withoutInterceptor();
  std::vector<std::string> words = {window.string()};
  if (!session_file.empty()) words.insert(words.end(), {"--session", session_file});
  words.insert(words.end(), {"--frame", std::to_string(common.frame), "--draw", std::to_string(common.draw)});
  if (!common.program.empty()) words.emplace_back("--");
  words.insert(words.end(), common.program.begin(), common.program.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(arguments[0], arguments.data());
  throw session::Error(session::Outcome::failed,
                       "cannot start '" + window.string() + "': " + strerror(errno));
}

}  // namespace

void addGui(CLI::App& app, Common& common, Action& action) {
  CLI::App* command = app.add_subcommand("gui", "open the window on a program");
  auto session_file = std::make_shared<std::string>();
  command->add_option("--frame", common.frame, "stop first at this frame, 0-based")->type_name("N");
  command->add_option("--draw", common.draw, "and this draw of it")->type_name("N");
  command->add_option("--session", *session_file, "open what the window saved")->type_name("FILE");
  command->callback([&common, &action, session_file] {
    action = [&common, session_file] { return run(common, *session_file); };
  });
}

}  // namespace shadestep::cli
