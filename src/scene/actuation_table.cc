#include <fmt/format.h>

#include <cassert>

#include "scene/sections.h"
#include "scene/time_table.h"
#include "softforce/base/input_error.h"

namespace softforce::scene {
namespace {

using base::Dimension;
using base::InputError;

// How an actuator's column is called, and what its numbers are multiplied with.
struct Column {
  std::string name;
  double in_si = 1;
};

Column ColumnOf(const Actuator& actuator) {
  const auto column = [&](const std::string& unit, Dimension dimension) {
    return Column{actuator.name + "_" + unit, base::UnitInSi(unit, dimension, actuator.name)};
  };
  switch (actuator.input) {
    case ActuatorInput::kTension:
      return column("N", Dimension::kForce);
    case ActuatorInput::kDisplacement:
      return column("mm", Dimension::kLength);
    case ActuatorInput::kPressure:
      return column("kPa", Dimension::kPressure);
  }
  assert(false);
  return {};
}

}  // namespace

ActuationTable ReadActuationTable(const std::filesystem::path& file,
                                  const std::vector<Actuator>& actuators) {
  std::vector<Column> columns;
  for (const Actuator& actuator : actuators) columns.push_back(ColumnOf(actuator));
  std::vector<std::string> names;
  for (const Column& column : columns) names.push_back(column.name);

  const TimeTable numbers = ReadTimeTable(file, names);
  ActuationTable table;
  table.time_s = numbers.time_s;
  table.inputs = numbers.values;
  for (size_t a = 0; a < actuators.size(); ++a) {
    table.inputs.col(a) *= columns[a].in_si;
    if (actuators[a].input != ActuatorInput::kTension) continue;
    for (size_t row = 0; row < table.time_s.size(); ++row) {
      if (table.inputs(row, a) >= 0) continue;
      throw InputError(
          fmt::format("{}:{}: column \"{}\"", file.string(), numbers.lines[row], names[a]),
          fmt::format("got a tension of {} N, expected 0 or more: a cable cannot push",
                      table.inputs(row, a)));
    }
  }
  return table;
}

Eigen::VectorXd ActuationTable::At(double time) const {
  assert(static_cast<Eigen::Index>(time_s.size()) == inputs.rows());
  return Interpolate(time_s, inputs, time);
}

}  // namespace softforce::scene
