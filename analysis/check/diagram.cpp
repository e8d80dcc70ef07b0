#include "analysis/check/diagram.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/common/converter.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/text_file.hpp"
#include "solver/builder/connects.hpp"

namespace bough::analysis {
namespace {

/// A quoted text of the language; \n in it stays a new line.
std::string quote(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '\n') {
      quoted += "\\n";
      continue;
    }
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

struct Style {
  const char *kind, *shape, *fill;
};
constexpr Style kStyles[] = {
    {"function", "ellipse", "#f3e8d2"}, {"sensor", "cds", "#dcebdd"},     {"input", "parallelogram", "#ffffff"},
    {"controller", "box", "#dde6f3"},   {"actuator", "house", "#f2dcdc"}, {"force", "house", "#efe3ee"},
    {"body", "box3d", "#e6e6e6"},       {"event", "diamond", "#ffffff"},  {"ground", "plaintext", "#ffffff"}};

const char* get_attributes(Diagram::Link link) {
  using Link = Diagram::Link;
  switch (link) {
    case Link::Signal:
      break;
    case Link::Push:
      return "style=bold";
    case Link::Measurement:
      return "style=dashed";
    case Link::Hinge:
      return "style=bold, color=\"#999999\", arrowhead=none";
    case Link::Constraint:
      return "style=bold, color=\"#999999\", arrowhead=odot, arrowtail=odot, dir=both";
    case Link::Element:
      return "style=dotted, dir=both";
    case Link::Event:
      return "style=dotted";
  }
  return "";
}

class Builder {
 public:
  explicit Builder(const records::SystemSpec& spec) : spec_(spec) {}

  Diagram build() {
    Diagnostics ignored;  // the system is built, which reports what is wrong
    const auto uses = solver::collect_uses(spec_, ignored);
    for (const auto& r : spec_.sensors) sources_.push_back({"sensor", r.name, "/sensors/" + r.name});
    for (const auto& r : spec_.inputs) sources_.push_back({"input", r.name, "/inputs/" + r.name});
    for (const auto& r : spec_.controllers) sources_.push_back({"controller", r.name, "/controllers/" + r.name});
    for (const auto& r : spec_.actuators) sources_.push_back({"actuator", r.name, "/actuators/" + r.name});
    for (const auto& r : spec_.functions) sources_.push_back({"function", r.name, "/signals/" + r.name});
    diagram_.name = spec_.name;
    add_signals(uses);
    add_plant();
    add_functions();
    add_events();
    return std::move(diagram_);
  }

 private:
  struct Source {
    std::string kind, name, path;
  };

  using Link = Diagram::Link;

  void node(const std::string& kind, const std::string& name, const std::string& label) {
    diagram_.nodes.push_back({kind, name, label});
  }
  void edge(const std::string& from, const std::string& to, const std::string& label, Link link = Link::Signal) {
    diagram_.edges.push_back({from, to, label, link, {}, {}, 0});
  }

  /// A wire from what `use` names; `key` of the table at `to` has it, unless a [[connect]] does.
  void wire(const solver::SignalUse& use, const std::string& to, const std::string& port, const std::string& key) {
    const auto matches = [](const Source& s, const std::string& name) { return s.name == name || s.path == name; };
    auto found = std::find_if(sources_.begin(), sources_.end(), [&](const auto& s) { return matches(s, use.text); });
    std::string component;
    if (const auto colon = use.text.rfind(':'); found == sources_.end() && colon != std::string::npos) {
      component = use.text.substr(colon + 1);
      found = std::find_if(sources_.begin(), sources_.end(),
                           [&](const auto& s) { return matches(s, use.text.substr(0, colon)); });
    }
    if (found == sources_.end()) return;
    std::string label = component;
    if (use.gain != 1) label += fmt::format("{}× {:g}", label.empty() ? "" : " ", use.gain);
    if (!port.empty()) label += (label.empty() ? "" : " ") + port;
    edge(found->kind + " " + found->name, to, label);
    auto& drawn = diagram_.edges.back();
    drawn.signal = key == "function" || key == "motion" || key == "of" ? found->name : use.text;
    drawn.line = use.at.line;
    const bool is_connect = std::any_of(spec_.connects.begin(), spec_.connects.end(),
                                        [&](const auto& record) { return record.at.line == use.at.line; });
    drawn.key = is_connect ? "from" : key;
  }

  static std::string describe_rate(const records::Settings& settings) {
    const double period = settings.get("sample_time", 0), delay = settings.get("delay", 0);
    if (period <= 0) return "";
    return fmt::format("\nevery {:g}", period) + (delay > 0 ? fmt::format(", delay {:g}", delay) : "");
  }

  void add_signals(const solver::SignalUses& uses) {
    for (const auto& r : spec_.inputs) node("input", r.name, r.name + "\n(input)");
    for (const auto& r : spec_.controllers) {
      const std::string me = "controller " + r.name;
      node("controller", r.name, r.name + "\n" + r.type + describe_rate(r.settings) + (r.active ? "" : "\n(off)"));
      const auto& own = uses.controllers.at(r.name);
      for (std::size_t i = 0; i < own.inputs.size(); ++i)
        wire(own.inputs[i], me, own.inputs.size() > 1 ? fmt::format("→ {}", i + 1) : "", "inputs");
      for (const auto& use : own.reference) wire(use, me, "→ reference", "reference");
      for (const auto& use : own.rate) wire(use, me, "→ rate", "rate");
    }
    for (const auto& r : spec_.actuators) {
      node("actuator", r.name, r.name + "\n" + r.type);
      if (const auto use = uses.actuators.find(r.name); use != uses.actuators.end())
        wire(use->second, "actuator " + r.name, "", "input");
      if (!r.hinge.empty())
        edge("actuator " + r.name, find_child(r.hinge), r.hinge, Link::Push);
      else if (!r.body.empty())
        edge("actuator " + r.name, "body " + r.body, name_node(r.node), Link::Push);
    }
    for (const auto& r : spec_.forces) {
      node("force", r.name, r.name + (r.locator.empty() ? "" : "\n" + r.locator));
      edge("force " + r.name, "body " + r.body, r.locator.empty() ? name_node(r.node) : "", Link::Push);
      if (!r.function.empty()) wire({"/signals/" + r.function, 1, r.at}, "force " + r.name, "", "function");
      if (const auto use = uses.forces.find(r.name); use != uses.forces.end())
        wire(use->second, "force " + r.name, "", "signal");
    }
    for (const auto& r : spec_.sensors) {
      node("sensor", r.name, r.name + describe_rate(r.chain));
      for (const auto& term : r.terms)
        edge("body " + term.body, "sensor " + r.name, name_node(term.node), Link::Measurement);
      if (!r.terms.empty()) continue;
      const std::string from = !r.hinge.empty() ? find_child(r.hinge) : "body " + r.body;
      edge(from, "sensor " + r.name, !r.hinge.empty() ? r.hinge : name_node(r.node), Link::Measurement);
    }
  }

  static std::string name_node(int node) { return node == 0 ? "" : fmt::format("node {}", node); }

  std::string find_child(const std::string& hinge) const {
    const auto found =
        std::find_if(spec_.hinges.begin(), spec_.hinges.end(), [&](const auto& h) { return h.name == hinge; });
    return found == spec_.hinges.end() ? "body " + hinge : "body " + found->child;
  }

  void add_plant() {
    const auto note_ground = [&](const std::string& name) { has_ground_ = has_ground_ || name == "ground"; };
    for (const auto& r : spec_.bodies) node("body", r.name, r.name + (r.file.empty() ? "\nrigid" : "\nflexible"));
    for (const auto& r : spec_.hinges) {
      note_ground(r.parent);
      edge("body " + r.parent, "body " + r.child, r.name, Link::Hinge);
    }
    for (const auto& r : spec_.constraints) {
      if (r.child.empty()) continue;
      note_ground(r.parent);
      note_ground(r.child);
      edge("body " + r.parent, "body " + r.child, r.name, Link::Constraint);
    }
    for (const auto& r : spec_.force_elements) {
      if (r.from.body.empty()) continue;
      note_ground(r.from.body);
      note_ground(r.to.body);
      edge("body " + r.from.body, "body " + r.to.body, r.name, Link::Element);
      if (!r.function.empty()) wire({"/signals/" + r.function, 1, r.at}, "body " + r.from.body, r.name, "function");
    }
    if (has_ground_) node("ground", "ground", "ground");
  }

  void add_functions() {
    for (const auto& r : spec_.hinges)
      for (const auto& name : r.motion)
        if (!name.empty()) wire({"/signals/" + name, 1, r.at}, "body " + r.child, r.name, "motion");
    for (const auto& r : spec_.functions)
      for (const auto& name : r.of) wire({"/signals/" + name, 1, r.at}, "function " + r.name, "", "of");
    for (const auto& r : spec_.functions) node("function", r.name, r.name + "\n" + r.type);
  }

  void add_events() {
    using records::EventAction;
    for (const auto& r : spec_.events) {
      const bool is_shown =
          r.action == EventAction::Enable || r.action == EventAction::Disable || r.action == EventAction::Switch;
      if (!is_shown) continue;
      node("event", r.name, r.name);
      const std::string what = r.action == EventAction::Enable    ? "enables"
                               : r.action == EventAction::Disable ? "disables"
                                                                  : fmt::format("switches to {}", r.choice);
      edge("event " + r.name, "controller " + r.target, what, Link::Event);
      if (!r.signal.empty()) wire({r.signal, 1, r.at}, "event " + r.name, "", "signal");
    }
  }

  const records::SystemSpec& spec_;
  std::vector<Source> sources_;
  bool has_ground_ = false;
  Diagram diagram_;
};

}  // namespace

Diagram make_diagram(const records::SystemSpec& spec) { return Builder(spec).build(); }

std::string write_dot(const Diagram& diagram) {
  std::string text = "digraph " + quote(diagram.name) + " {\n  rankdir=LR;\n  label=" + quote(diagram.name) +
                     ";\n  labelloc=t;\n  fontname=\"Helvetica\";\n  nodesep=0.25;\n  ranksep=0.6;\n"
                     "  node [fontname=\"Helvetica\", fontsize=11, style=filled, color=\"#555555\"];\n"
                     "  edge [fontname=\"Helvetica\", fontsize=9, color=\"#555555\", arrowsize=0.7];\n";
  for (const auto& node : diagram.nodes)
    for (const auto& style : kStyles)
      if (node.kind == style.kind)
        text += fmt::format("  {} [label={}, shape={}, fillcolor=\"{}\"];\n", quote(node.id()), quote(node.label),
                            style.shape, style.fill);
  for (const auto& edge : diagram.edges) {
    const std::string label = edge.label.empty() ? "" : "label=" + quote(edge.label);
    const std::string look = get_attributes(edge.link);
    const std::string attributes = label + (label.empty() || look.empty() ? "" : ", ") + look;
    text +=
        "  " + quote(edge.from) + " -> " + quote(edge.to) + (attributes.empty() ? "" : " [" + attributes + "]") + ";\n";
  }
  return text + "}\n";
}

void write_diagram(const records::SystemSpec& spec, const std::string& path) {
  const std::string text = write_dot(make_diagram(spec));
  if (has_suffix(path, ".dot")) return write_text_file(path, text);
  std::string format;
  for (const char* known : {"svg", "png", "pdf"})
    if (has_suffix(path, std::string(".") + known)) format = known;
  if (format.empty())
    throw InputError("cli.bad-diagram", {path}, "the ending of the diagram's file names no format",
                     "end it in .dot, .svg, .png or .pdf");
  write_converted(path, text,
                  {"dot", "graphviz", "write .dot",
                   [&](const std::string& source, const std::string& output) -> std::vector<std::string> {
                     return {"-T" + format, "-o" + output, source};
                   }});
}

}  // namespace bough::analysis
