// Linear models: arrays that go straight into python-control and scipy.signal.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include <pybind11/stl/filesystem.h>

#include "python/bindings/bindings.hpp"

#include "formats/hdf5/linear_file.hpp"
#include "solver/statespace/uncertainty.hpp"

namespace bough::python {

namespace {

using records::LinearModel;

template <class Member>
auto show(Member LinearModel::*member) {
  return [member](py::object self) { return view(self.cast<LinearModel&>().*member, self); };
}

py::array make_complex(const Eigen::VectorXd& real, const Eigen::VectorXd& imag) {
  Eigen::VectorXcd values(real.size());
  values.real() = real;
  values.imag() = imag;
  return give(std::move(values));
}

}  // namespace

void bind_linear(py::module_& m) {
  py::class_<LinearModel>(m, "LinearModel", "x' = A x + B u, y = C x + D u about an operating point.")
      .def_property_readonly("A", show(&LinearModel::A))
      .def_property_readonly("B", show(&LinearModel::B))
      .def_property_readonly("C", show(&LinearModel::C))
      .def_property_readonly("D", show(&LinearModel::D))
      .def_property_readonly(
          "second_order",
          [](const LinearModel& l) -> py::object {
            auto second = records::make_second_order(l);
            if (second.M.size() == 0) return py::none();
            return py::make_tuple(give(std::move(second.M)), give(std::move(second.D)), give(std::move(second.K)),
                                  give(std::move(second.F)), give(std::move(second.Z)));
          },
          "(M, D, K, F, Z): M d'' + D d' + K d = F u + Z z, d the displacements, z the states of controllers; None of "
          "a "
          "sampled loop")
      .def_property_readonly("states", [](const LinearModel& l) { return l.states.name; })
      .def_property_readonly("inputs", [](const LinearModel& l) { return l.inputs.name; })
      .def_property_readonly("outputs", [](const LinearModel& l) { return l.outputs.name; })
      .def_property_readonly(
          "uncertainty",
          [](const LinearModel& l) {
            py::list list;
            for (const auto& one : l.uncertainty) list.append(py::make_tuple(one.name, one.low, one.high, one.size));
            return list;
          },
          "(name, value at delta -1, value at delta 1, number of inputs w and outputs z), which come first")
      .def(
          "close",
          [](const LinearModel& l, const std::vector<double>& delta) {
            if (delta.size() != l.uncertainty.size())
              throw py::value_error("expected " + std::to_string(l.uncertainty.size()) + " values, found " +
                                    std::to_string(delta.size()));
            for (const double value : delta)
              if (!std::isfinite(value))
                throw py::value_error("expected finite values, found " + std::to_string(value));
            const auto is_outside = [](double value) { return std::abs(value) > 1 + 1e-12; };
            if (const auto found = std::find_if(delta.begin(), delta.end(), is_outside); found != delta.end()) {
              const auto& one = l.uncertainty[static_cast<std::size_t>(found - delta.begin())];
              std::ostringstream text;
              text << "delta of " << one.name << " is " << *found
                   << ", outside [-1, 1]: the model extrapolates beyond the range " << one.low << " to " << one.high;
              if (PyErr_WarnEx(PyExc_UserWarning, text.str().c_str(), 1) != 0) throw py::error_already_set();
            }
            return statespace::close_uncertainty(
                l, Eigen::Map<const Eigen::VectorXd>(delta.data(), static_cast<Eigen::Index>(delta.size())));
          },
          py::arg("delta"),
          "The model with w = delta z closed, one value in [-1, 1] per parameter; UserWarning outside.")
      .def_readonly("time", &LinearModel::time)
      .def_property_readonly("q", show(&LinearModel::q))
      .def_property_readonly("u", show(&LinearModel::u))
      .def_readonly("residual", &LinearModel::residual, "|u'| at the operating point")
      .def_readonly("error", &LinearModel::error, "estimated, of A and C, relative to the largest entry of the row")
      .def_property_readonly("poles", [](const LinearModel& l) { return make_complex(l.poles.real, l.poles.imag); })
      .def_property_readonly("pole_frequency_hz",
                             [](const LinearModel& l) { return give(Eigen::VectorXd(l.poles.frequency_hz)); })
      .def_property_readonly("pole_damping",
                             [](const LinearModel& l) { return give(Eigen::VectorXd(l.poles.damping)); })
      .def_property_readonly("pole_mode", [](const LinearModel& l) { return l.poles.mode; })
      .def_property_readonly("zeros",
                             [](const LinearModel& l) -> py::object {
                               if (!l.has_zeros) return py::none();
                               return make_complex(l.zeros_real, l.zeros_imag);
                             })
      .def("save", make_save<LinearModel>(&hdf5::write_linear_model), py::arg("path"), OneAtATime(),
           "Write the linear-model HDF5 file.")
      .def("__repr__", [](const LinearModel& l) {
        return "<LinearModel: " + std::to_string(l.A.rows()) + " states, " + std::to_string(l.B.cols()) + " inputs, " +
               std::to_string(l.C.rows()) + " outputs>";
      });
  m.def(
      "read_linear_model", [](const std::filesystem::path& path) { return hdf5::read_linear_model(path); },
      py::arg("path"), OneAtATime());
}

}  // namespace bough::python
