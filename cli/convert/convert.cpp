#include "analysis/convert/convert.hpp"

#include <CLI/CLI.hpp>

#include "analysis/common/text_file.hpp"
#include "cli/common/console_events.hpp"
#include "cli/common/options.hpp"
#include "cli/verbs.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::cli {

namespace {

using ConvertOptions = RequestOptions<analysis::ConvertRequest>;

int run_convert(const ConvertOptions& o) {
  Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  auto request = o.request;
  request.output = o.output;
  ConsoleEvents events(console);
  const auto check = [&](const std::string& path, const std::vector<std::string>& inputs) {
    check_output(o, path, inputs);
  };
  const auto answer = analysis::convert_file(request, check, events);
  console.print(events.get_messages());
  for (const auto& file : answer.files) {
    analysis::write_text_file(file.path, file.text);
    console.print("written: " + file.path + "\n");
  }
  const std::string names =
      answer.from.empty() ? " converted\n" : " converted from " + answer.from + " to " + answer.to + "\n";
  if (answer.kind == analysis::ConvertedKind::FlexBody) {
    if (answer.files.empty()) {
      hdf5::write_flex_body(answer.body, answer.accuracy, o.output);
      console.print("written: " + o.output + "\n");
    }
    console.print("flexible body" + names);
  } else {
    console.print(count(answer.num_changed, answer.kind == analysis::ConvertedKind::Deck ? "field" : "value") + names);
  }
  return kSuccess;
}

}  // namespace

void add_convert(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb(app, action, run_convert, "convert");
  verb->add_option("file", o->request.file, "Nastran deck with its INCLUDE files, system or body file, flexible body")
      ->required();
  auto* units = verb->add_option("--units", o->request.units, "FROM:TO, as mm-N-tonne:m-kg-s")->type_name("FROM:TO");
  auto* from =
      verb->add_option("--from", o->request.from, "The file's units, as mm-N-tonne or in-lbf-s")->excludes(units);
  auto* to = verb->add_option("--to", o->request.to, "The units wanted")->excludes(units);
  from->needs(to);
  to->needs(from);
  verb->add_flag("--radians", o->request.to_radians, "System file: keys in degrees (_deg) become radians");
  add_common_options(*verb, *o, kOutput, "The file to write");
  verb->get_option("--output")->required();
}

}  // namespace bough::cli
