#include "formats/nastran/loads_deck.hpp"

#include <map>

#include "base/diagnostic.hpp"
#include "formats/nastran/detail/card_sink.hpp"

namespace bough::nastran {

namespace {

constexpr const char* kLoads[] = {"acceleration x",
                                  "acceleration y",
                                  "acceleration z",
                                  "angular acceleration x",
                                  "angular acceleration y",
                                  "angular acceleration z",
                                  "square of the rate x",
                                  "square of the rate y",
                                  "square of the rate z",
                                  "product of the rates x, y",
                                  "product of the rates x, z",
                                  "product of the rates y, z"};

void put(detail::CardSink& sink, const char* card, int set, int grid, const Eigen::Vector3d& v) {
  if (!v.isZero(0)) sink.put(detail::CardFields(card).add(set).add(grid).add_id(0).add(1.0).add(v));
}

}  // namespace

std::string write_loads_deck(const records::FlexBody& body, int first_set) {
  BOUGH_DEMAND(body.F_I.rows() == body.dof_map.rows() && body.F_I.cols() == records::kNumInertialLoads);
  detail::CardSink sink;
  sink.out = "$ Inertial loads F_I of body " + body.name + ", by bough reduce --loads-deck.\n" +
             "$ A load set for each entry of A_I (NASA-CR-202063, eqs. 3-12): what a unit of it does to the masses,\n" +
             "$ about the origin of the body frame, in basic axes. To be included in the bulk data of the deck that\n" +
             "$ was reduced; a static SUBCASE with LOAD = " + std::to_string(first_set) + " ... " +
             std::to_string(first_set + records::kNumInertialLoads - 1) +
             " each, on constraints that hold the frame\n$ of the body, gives the stress whose geometric stiffness is "
             "K_G(F_I).\n";
  for (int l = 0; l < records::kNumInertialLoads; ++l) {
    const int set = first_set + l;
    sink.out += "$\n$ Load set " + std::to_string(set) + ", A_I(" + std::to_string(l + 1) + "): " + kLoads[l] + "\n";
    std::map<int, Eigen::Matrix<double, 6, 1>> nodes;
    std::map<int, double> points;
    for (Eigen::Index row = 0; row < body.F_I.rows(); ++row) {
      const int id = body.dof_map(row, 0), code = body.dof_map(row, 1);
      if (code == 0)
        points[id] = body.F_I(row, l);
      else
        nodes.try_emplace(id, Eigen::Matrix<double, 6, 1>::Zero()).first->second[code - 1] = body.F_I(row, l);
    }
    const auto before = sink.out.size();
    for (const auto& [id, load] : nodes) {
      put(sink, "FORCE", set, id, load.head<3>());
      put(sink, "MOMENT", set, id, load.tail<3>());
    }
    for (const auto& [id, load] : points)
      if (load != 0) sink.put(detail::CardFields("SLOAD").add(set).add(id).add(load));
    if (sink.out.size() == before) sink.out += "$ no card: this load is zero\n";
  }
  return sink.out;
}

}  // namespace bough::nastran
