#include <CLI/CLI.hpp>
#include <sstream>

#include "base/version.hpp"
#include "cli/common/help_files.hpp"

namespace bough::cli {

namespace {

/// Text as roff prints it unchanged: a backslash and a hyphen are commands, a dot or quote at a line's start a request.
std::string escape(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) out += "\\&";
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
  }
  return out;
}

std::string bold(const std::string& text) { return "\\fB" + escape(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + escape(text) + "\\fR"; }

/// A footer: indented lines, the examples, are kept as they are, the others fill paragraphs.
std::string format_footer(const std::string& text) {
  std::string out = ".PP\n", line;
  bool kept = false;
  for (std::istringstream in(text); std::getline(in, line);) {
    const bool keep = line.rfind("  ", 0) == 0;
    if (keep != kept) out += keep ? ".nf\n" : ".fi\n.PP\n";
    kept = keep;
    out += escape(line) + "\n";
  }
  return kept ? out + ".fi\n" : out;
}

/// "-o, --output TEXT" or the name of a positional, with what it takes.
std::string format_names(const CLI::Option& option) {
  std::string out;
  for (const auto& name : option.get_snames()) out += (out.empty() ? "" : ", ") + bold("-" + name);
  for (const auto& name : option.get_lnames()) out += (out.empty() ? "" : ", ") + bold("--" + name);
  if (out.empty()) out = italic(option.get_name());
  if (option.get_type_size() == 0) return out;
  if (option.nonpositional()) out += " " + italic(option.get_type_name());
  if (option.get_expected_max() == CLI::detail::expected_max_vector_size) out += " ...";
  if (!option.get_default_str().empty()) out += " (default " + escape(option.get_default_str()) + ")";
  if (option.get_required() && option.nonpositional()) out += " (required)";
  return out;
}

std::string format_options(const CLI::App& app) {
  std::string out;
  for (const auto* option : app.get_options()) {
    if (option->get_group().empty()) continue;  // not for users
    out += ".TP\n" + format_names(*option) + "\n" + escape(option->get_description()) + "\n";
  }
  return out;
}

std::string format_synopsis(const CLI::App& verb) {
  std::string out = ".B bough " + verb.get_name() + "\n[\\fIOPTIONS\\fR]";
  for (const auto* option : verb.get_options([](const CLI::Option* o) { return !o->nonpositional(); })) {
    const bool many = option->get_expected_max() == CLI::detail::expected_max_vector_size;
    const auto name = italic(option->get_name()) + (many ? " ..." : "");
    out += " " + (option->get_required() ? name : "[" + name + "]");
  }
  return out + "\n";
}

}  // namespace

std::vector<std::pair<std::string, std::vector<const CLI::App*>>> list_command_groups(const CLI::App& app) {
  std::vector<std::pair<std::string, std::vector<const CLI::App*>>> groups;
  for (const auto* verb : app.get_subcommands(nullptr)) {
    if (groups.empty() || groups.back().first != verb->get_group()) groups.push_back({verb->get_group(), {}});
    groups.back().second.push_back(verb);
  }
  return groups;
}

std::string make_man_page(const CLI::App& app) {
  std::string out = ".TH BOUGH 1 \"\" \"Bough " + std::string(get_version()) + "\" \"User Commands\"\n.SH NAME\n" +
                    "bough \\- from a finite\\-element model to a flexible multibody simulation\n.SH SYNOPSIS\n";
  const auto verbs = app.get_subcommands(nullptr);
  for (const auto* verb : verbs) out += (verb == verbs.front() ? "" : ".br\n") + format_synopsis(*verb);
  out += ".SH DESCRIPTION\n" + format_footer(app.get_footer()) + ".SH OPTIONS\n" + format_options(app);
  out += ".SH COMMANDS\n";
  for (const auto& [heading, members] : list_command_groups(app)) {
    out += ".PP\n" + escape(heading) + ":\n";
    for (const auto* verb : members) out += verb->get_name() + (verb == members.back() ? ".\n" : ",\n");
  }
  for (const auto* verb : verbs) {
    out += ".SS bough " + verb->get_name() + "\n" + escape(verb->get_description()) + "\n" + format_options(*verb);
    out += format_footer(verb->get_footer());
  }
  out += ".SH SEE ALSO\n";
  for (const auto* verb : verbs)
    out += ".BR bough\\-" + verb->get_name() + " (1)" + (verb == verbs.back() ? "\n" : ",\n");
  return out;
}

std::string make_verb_man_page(const CLI::App& app, const std::string& name) {
  const CLI::App* verb = nullptr;
  for (const auto* each : app.get_subcommands(nullptr))
    if (each->get_name() == name) verb = each;
  if (!verb) return {};
  std::string upper = name;
  for (auto& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  auto about = verb->get_description();
  for (auto& c : about)
    if (c == '\n') c = ' ';
  return ".TH BOUGH\\-" + upper + " 1 \"\" \"Bough " + std::string(get_version()) + "\" \"User Commands\"\n.SH NAME\n" +
         "bough\\-" + name + " \\- " + escape(about) + "\n.SH SYNOPSIS\n" + format_synopsis(*verb) + ".SH OPTIONS\n" +
         format_options(*verb) + ".SH DESCRIPTION\n" + format_footer(verb->get_footer()) +
         ".SH SEE ALSO\n.BR bough (1)\n";
}

}  // namespace bough::cli
