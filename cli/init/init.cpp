#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "analysis/common/output_folder.hpp"
#include "analysis/common/text_file.hpp"
#include "analysis/init/init_deck.hpp"
#include "cli/common/console.hpp"
#include "cli/common/number_checks.hpp"
#include "cli/common/options.hpp"
#include "cli/init/schema_line.hpp"
#include "cli/init/templates.hpp"

namespace bough::cli {

namespace fs = std::filesystem;

namespace {

struct InitOptions {
  std::string name, output;
  int hinge = 0;
  bool quiet = false, force = false, lists = false;
};

struct Files {
  std::string folder, advice;
  std::vector<analysis::StartFile> files;
};

const Template& find_template(const std::string& name) {
  std::vector<std::string> names;
  std::string list;
  for (const auto& t : get_templates()) {
    if (name == t.name || name == t.folder) return t;
    names.push_back(t.name);
    list += (list.empty() ? "" : ", ") + std::string(t.name);
  }
  const auto nearest = find_nearest(name, names);
  throw InputError("cli.unknown-template", {}, "no template \"" + name + "\"",
                   nearest.empty() ? "the templates are " + list : "did you mean \"" + nearest + "\"");
}

bool is_deck(const std::string& name) { return fs::path(name).has_extension() || fs::is_regular_file(name); }

Files make_files(const InitOptions& o, Diagnostics& diagnostics) {
  Files made;
  if (!is_deck(o.name)) {
    const auto& chosen = find_template(o.name);
    made.folder = chosen.name;
    made.advice = "README.md in that folder explains the example and how to run it\n";
    for (const auto& file : chosen.files) made.files.push_back({file.name, file.text});
    return made;
  }
  made.folder = ".";
  made.files = analysis::make_start_files(o.name, o.output, o.hinge, diagnostics);
  made.advice = "bough reduce takes the first file; then bough run takes the second\n";
  return made;
}

/// The heading of the template's README: "# ex01: spin-up of a boom" -> "spin-up of a boom".
std::string describe(const Template& chosen) {
  for (const auto& file : chosen.files) {
    if (std::string(file.name) != "README.md") continue;
    const std::string text = file.text;
    const auto heading = text.substr(0, text.find('\n'));
    const auto colon = heading.find(": ");
    return colon == std::string::npos ? heading : heading.substr(colon + 2);
  }
  return {};
}

int list_templates(const Console& console) {
  std::size_t width = 0;
  for (const auto& known : get_templates()) width = std::max(width, std::string(known.name).size());
  for (const auto& known : get_templates()) {
    std::string name = known.name;
    name.resize(width + 2, ' ');
    console.print_data(name + describe(known) + "\n");
  }
  console.print("bough init NAME copies an example; bough init DECK.bdf writes a body and a system file for a deck\n");
  return kSuccess;
}

/// Files and folders that one call makes: all of them stay, or none. A file that was overwritten (--force) stays.
class NewPaths {
 public:
  NewPaths() = default;
  NewPaths(const NewPaths&) = delete;
  NewPaths& operator=(const NewPaths&) = delete;
  ~NewPaths() {
    std::error_code ignored;
    for (auto path = paths_.rbegin(); path != paths_.rend(); ++path) fs::remove(*path, ignored);
  }

  void make_folder(const fs::path& folder) {
    std::vector<fs::path> missing;
    std::error_code failed;
    for (fs::path path = fs::absolute(folder).lexically_normal(); !path.empty() && !fs::exists(path, failed);) {
      if (path.has_filename()) missing.push_back(path);
      path = path.parent_path();
    }
    paths_.insert(paths_.end(), missing.rbegin(), missing.rend());
    fs::create_directories(folder, failed);
    if (failed)
      throw ComputationError("cli.write", {folder.string()}, "the folder could not be made: " + failed.message(),
                             "choose another with -o");
  }
  void write(const fs::path& path, const std::string& text) {
    if (!fs::exists(path)) paths_.push_back(path);
    analysis::write_text_file(path.string(), text);
  }
  void keep() { paths_.clear(); }

 private:
  std::vector<fs::path> paths_;
};

int run_init(const InitOptions& o) {
  const Console console(o.quiet, 0);
  if (!console.is_root()) return kSuccess;
  if (o.name.empty() || o.lists) return list_templates(console);
  Diagnostics diagnostics;
  Files chosen = make_files(o, diagnostics);
  for (auto& file : chosen.files) add_schema_line(file);
  console.print(diagnostics);
  const fs::path folder = o.output.empty() ? fs::path(chosen.folder) : fs::path(o.output);
  for (const auto& file : chosen.files) {
    const auto path = (folder / file.name).string();
    analysis::check_place(path);
    if (!o.force && fs::exists(path)) {
      diagnostics.error("cli.output-exists", {path}, "the file exists", "choose another folder with -o, or --force");
    }
  }
  diagnostics.throw_if_errors();
  NewPaths made;
  made.make_folder(folder);
  for (const auto& file : chosen.files) made.write(folder / file.name, file.text);
  made.keep();
  for (const auto& file : chosen.files) console.print((folder / file.name).string() + "\n");
  console.print(chosen.advice);
  return kSuccess;
}

}  // namespace

void add_init(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb(app, action, run_init, "init");
  std::string names;
  for (const auto& known : get_templates()) names += std::string(names.empty() ? "" : ", ") + known.name;
  verb->add_option("template", o->name, names + "; or a Nastran deck. Default: lists them");
  verb->add_option("-o,--output", o->output, "Folder to write into (default: the template's name; for a deck, here)");
  verb->add_option("--hinge", o->hinge, "Of a deck: the grid on a revolute hinge to ground; chooses the basis for it")
      ->check(is_positive());
  verb->add_flag("--list", o->lists, "List the templates, as without a name");
  verb->add_flag("--force", o->force, "Overwrite files that are there already");
  verb->add_flag("-q,--quiet", o->quiet, "Print errors only");
  verb->add_flag("-v,--verbose")->description("Accepted as by every command; init has no further messages");
}

}  // namespace bough::cli
