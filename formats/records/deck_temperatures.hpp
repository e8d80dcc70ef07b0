#pragma once
/// \file Temperatures of grids and elements, materials over temperature: included by deck.hpp.
#include <map>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "formats/records/card_location.hpp"
#include "formats/records/function_table.hpp"

namespace bough::records {

struct GridTemperature {  ///< TEMP
  int sid = 0, g = 0;
  double t = 0;
  CardLocation at;
};
struct DefaultTemperature {  ///< TEMPD: of the grids that have no TEMP
  int sid = 0;
  double t = 0;
  CardLocation at;
};
/// TEMPRB, one for each element: a bar, beam, rod or tube. Gradients (by y, by z) of the section at ends A and B, in
/// element axes.
struct BarTemperature {
  int sid = 0, element = 0;
  double t_a = 0, t_b = 0;
  Eigen::Vector2d gradient_a = Eigen::Vector2d::Zero(), gradient_b = Eigen::Vector2d::Zero();
  CardLocation at;
};
/// TEMPP1, one for each element: a shell.
struct PlateTemperature {
  int sid = 0, element = 0;
  double t = 0;         ///< at the reference surface
  double gradient = 0;  ///< along the normal
  CardLocation at;
};

/// MATT1, MATT2, MATT8, MATT9, MATT11: tables over temperature in place of the fields of a material.
struct MaterialTables {
  std::string material;  ///< MAT1, MAT2, MAT8, MAT9, MAT11
  int mid = 0;
  std::vector<int> tables;  ///< TABLEMi of each field of the material after its id; 0: the field counts
  CardLocation at;
};

struct TemperatureCards {
  std::vector<GridTemperature> grids;
  std::vector<DefaultTemperature> defaults;
  std::vector<BarTemperature> bars;
  std::vector<PlateTemperature> plates;
  std::vector<MaterialTables> materials;
  std::vector<FunctionTable> tables;  ///< TABLEM1 to TABLEM4
  /// Property of the deck by the id of its copy at a temperature; empty before materials are evaluated.
  std::map<int, int> properties;
};

}  // namespace bough::records
