#include "base/platform.hpp"
#include "cli/verbs.hpp"

#include <spawn.h>
#include <sys/wait.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "analysis/common/body_files.hpp"
#include "analysis/common/output_folder.hpp"
#include "analysis/common/ranks.hpp"
#include "base/diagnostic.hpp"
#include "cli/common/console.hpp"
#include "cli/common/interrupt.hpp"
#include "cli/common/number_checks.hpp"
#include "cli/common/options.hpp"
#include "cli/studio/answers.hpp"
#include "cli/studio/server.hpp"

namespace bough::cli {

namespace fs = std::filesystem;

namespace {

struct StudioOptions : CommonOptions {
  std::vector<std::string> files;
  int port = 0;
  bool no_open = false, answers = false;
};

std::atomic<bool>& get_end_flag() {
  static std::atomic<bool> end{false};
  return end;
}
void on_signal(int) { get_end_flag().store(true); }

/// Opens the address in the browser of the desktop; nothing without a desktop.
void open_browser(const std::string& address) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
  std::string program = "xdg-open", argument = address;
  char* words[] = {program.data(), argument.data(), nullptr};
  pid_t pid = 0;
  if (posix_spawnp(&pid, "xdg-open", nullptr, nullptr, words, platform::get_environment()) != 0) return;
  std::thread([pid] {
    int status = 0;
    waitpid(pid, &status, 0);
  }).detach();
}

int run_studio(const StudioOptions& o) {
  if (o.answers) return answer_standard_input();
  const Console console(o.quiet, o.verbosity);
  if (analysis::is_one_of_many())
    throw InputError("studio.ranks", {}, "the studio runs in one process", "start it without mpirun");
  ServerOptions options;
  options.folder = fs::canonical(fs::current_path()).string();
  options.port = o.port;
  for (const auto& file : o.files) {
    analysis::demand_body_file(file);
    if (!analysis::is_inside(analysis::get_body_path(file), options.folder))
      throw InputError("cli.outside-folder", {file},
                       "the file does not lie in " + options.folder + ", the folder of the studio",
                       "start bough studio in a folder that contains all files");
    options.files.push_back(fs::relative(fs::absolute(file), fs::current_path()).generic_string());
  }
  StudioServer server(std::move(options));
  get_end_flag().store(false);
  const SignalScope signals(on_signal);
  server.start();
  console.print_data(server.get_address() + "\n");
  console.print("files below this folder; ends with Ctrl-C or the button End\n");
  flush_data();
  if (!o.no_open) open_browser(server.get_address());
  while (!get_end_flag().load() && server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  server.stop();
  return kSuccess;
}

}  // namespace

void add_studio(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb(app, action, run_studio, "studio");
  verb->add_option("files", o->files, "Decks, body.toml, system.toml, results and other .h5 files to open at first");
  verb->add_option("--port", o->port, "Port of 127.0.0.1 (default: a free one)")->check(is_within(1, 65535));
  verb->add_flag("--no-open", o->no_open, "Print the address and open no browser");
  verb->add_flag("--answer", o->answers, "Answer one request from standard input")->group("");
  add_common_options(*verb, *o, 0);
}

}  // namespace bough::cli
