#include "cli/studio/deck_answer.hpp"

#include <cstdint>
#include <map>
#include <vector>

#include "analysis/common/inputs.hpp"
#include "analysis/picture/deck_picture.hpp"
#include "formats/nastran/reader.hpp"
#include "report/drawing.hpp"
#include "report/pack.hpp"

namespace bough::cli {

using nlohmann::json;

namespace {

using Indices = std::vector<std::uint32_t>;

json make_vector(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// Elements by columns: id, card (index into "cards"), property, file and line.
json make_elements(const analysis::DeckPicture& picture, const report::Drawing& drawing) {
  std::map<std::string, std::uint32_t> number;
  auto cards = json::array();
  Indices id, card, property, file, line;
  for (const auto& e : picture.elements) {
    const auto [at, is_new] = number.emplace(e.card, static_cast<std::uint32_t>(number.size()));
    if (is_new) cards.push_back(e.card);
    id.push_back(static_cast<std::uint32_t>(e.id));
    card.push_back(at->second);
    property.push_back(static_cast<std::uint32_t>(e.property));
    file.push_back(static_cast<std::uint32_t>(e.at.file));
    line.push_back(static_cast<std::uint32_t>(e.at.line));
  }
  return {{"id", report::pack_indices(id)},
          {"card", report::pack_indices(card)},
          {"property", report::pack_indices(property)},
          {"file", report::pack_indices(file)},
          {"line", report::pack_indices(line)},
          {"cards", cards},
          {"of_triangle", report::pack_indices(drawing.elements.of_triangle)},
          {"of_edge", report::pack_indices(drawing.elements.of_edge)}};
}

json make_grids(const analysis::DeckPicture& picture) {
  Indices file, line, part;
  for (const auto& at : picture.grids) {
    file.push_back(static_cast<std::uint32_t>(at.file));
    line.push_back(static_cast<std::uint32_t>(at.line));
  }
  for (const int p : picture.part) part.push_back(static_cast<std::uint32_t>(p + 1));  // 0: in no element
  return {{"id", report::pack_indices({picture.mesh.grid_id.begin(), picture.mesh.grid_id.end()})},
          {"file", report::pack_indices(file)},
          {"line", report::pack_indices(line)},
          {"part", report::pack_indices(part)}};
}

void add_symbols(const analysis::DeckPicture& picture, json& out) {
  for (const char* key : {"masses", "spiders", "supports", "loads", "systems", "properties"}) out[key] = json::array();
  for (const auto& m : picture.masses)
    out["masses"].push_back({{"id", m.id},
                             {"card", m.card},
                             {"grid", m.grid},
                             {"mass", m.mass},
                             {"place", make_vector(m.place)},
                             {"file", m.at.file},
                             {"line", m.at.line}});
  for (const auto& s : picture.spiders)
    out["spiders"].push_back({{"id", s.id},
                              {"card", s.card},
                              {"centre", s.centre},
                              {"grids", s.grids},
                              {"file", s.at.file},
                              {"line", s.at.line}});
  for (const auto& s : picture.supports)
    out["supports"].push_back({{"grid", s.grid}, {"set", s.set}, {"components", s.components}});
  for (const auto& l : picture.loads)
    out["loads"].push_back(
        {{"grid", l.grid}, {"set", l.set}, {"vector", make_vector(l.vector)}, {"moment", l.is_moment}});
  for (const auto& s : picture.systems)
    out["systems"].push_back(
        {{"id", s.id},
         {"origin", make_vector(s.origin)},
         {"axes", {make_vector(s.axes.col(0)), make_vector(s.axes.col(1)), make_vector(s.axes.col(2))}}});
  for (const auto& p : picture.properties)
    out["properties"].push_back(
        {{"id", p.id}, {"card", p.card}, {"values", p.values}, {"file", p.at.file}, {"line", p.at.line}});
}

/// Sections of line elements: shapes by property, columns of the elements that have them, released ends.
json make_line_sections(const analysis::LineSections& found) {
  auto shapes = json::array(), pins = json::array();
  for (const auto& section : found.sections) {
    auto stations = json::array();
    for (const auto& station : section.stations) {
      auto faces = json::array();
      for (const auto& face : station.faces) {
        auto corners = json::array();
        for (const auto& corner : face) corners.push_back({corner.x(), corner.y()});
        faces.push_back(corners);
      }
      stations.push_back({{"x", station.x_over_L}, {"faces", faces}});
    }
    shapes.push_back({{"card", section.card},
                      {"id", section.id},
                      {"text", section.text},
                      {"equivalent", section.is_equivalent},
                      {"stations", stations}});
  }
  Indices element, shape;
  Eigen::VectorXd frame(12 * static_cast<Eigen::Index>(found.lines.size()));
  for (std::size_t k = 0; k < found.lines.size(); ++k) {
    const auto& line = found.lines[k];
    element.push_back(static_cast<std::uint32_t>(line.element));
    shape.push_back(static_cast<std::uint32_t>(line.section));
    frame.segment<12>(12 * static_cast<Eigen::Index>(k)) << line.a, line.b, line.y, line.z;
  }
  for (const auto& pin : found.pins)
    pins.push_back({{"element", pin.element}, {"components", pin.components}, {"place", make_vector(pin.place)}});
  return {{"shapes", shapes},
          {"element", report::pack_indices(element)},
          {"shape", report::pack_indices(shape)},
          {"frame", report::pack_floats(frame)},
          {"pins", pins},
          {"without", found.num_without}};
}

}  // namespace

json make_deck_answer(const std::string& file, Diagnostics& diagnostics) {
  analysis::demand_deck(file);
  const auto deck = nastran::read_deck(file, {}, diagnostics);
  const auto picture = analysis::make_deck_picture(deck, diagnostics);
  const auto drawing = report::make_drawing(picture.mesh, picture.mesh.grid_id, picture.mesh.grid_xyz, {});
  json out{{"drawing", json::parse(report::to_json_text(drawing))},
           {"elements", make_elements(picture, drawing)},
           {"grids", make_grids(picture)},
           {"line_sections", make_line_sections(picture.line_sections)},
           {"num_parts", picture.num_parts},
           {"files", deck.files},
           {"sol", deck.sol},
           {"cards", deck.card_counts}};
  add_symbols(picture, out);
  return out;
}

}  // namespace bough::cli
