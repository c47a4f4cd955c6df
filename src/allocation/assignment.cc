#include "allocation/assignment.h"

#include <cassert>
#include <limits>

namespace softforce::allocation {

Assignment AssignRows(const Eigen::MatrixXd& cost) {
  const int rows = static_cast<int>(cost.rows());
  const int columns = static_cast<int>(cost.cols());
  assert(rows <= columns);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();

  // cost(r, c) − row_price(r) − column_price(c) ≥ 0, and 0 on the pairs chosen so far.
  std::vector<double> row_price(rows, 0), column_price(columns, 0);
  std::vector<int> row_of_column(columns, -1);
  for (int start = 0; start < rows; ++start) {
    // Dijkstra from row `start` over columns, along chosen pairs, to the nearest column that is
    // free.
    std::vector<double> distance(columns, kInfinity);
    std::vector<int> came_from(columns,
                               -1);  // the column before it on the path; −1: directly from `start`
    std::vector<char> settled(columns, 0);
    int row = start;
    int column = -1;
    double travelled = 0;
    do {
      for (int c = 0; c < columns; ++c) {
        if (settled[c]) continue;
        const double d = travelled + cost(row, c) - row_price[row] - column_price[c];
        if (d < distance[c]) {
          distance[c] = d;
          came_from[c] = column;
        }
      }
      int nearest = -1;
      for (int c = 0; c < columns; ++c) {
        if (!settled[c] && (nearest < 0 || distance[c] < distance[nearest])) nearest = c;
      }
      column = nearest;
      settled[column] = 1;
      travelled = distance[column];
      row = row_of_column[column];
    } while (row >= 0);

    row_price[start] += travelled;
    for (int c = 0; c < columns; ++c) {
      if (!settled[c]) continue;
      column_price[c] -= travelled - distance[c];
      if (row_of_column[c] >= 0) row_price[row_of_column[c]] += travelled - distance[c];
    }
    while (column >= 0) {  // shift the pairs along the path
      const int before = came_from[column];
      row_of_column[column] = before >= 0 ? row_of_column[before] : start;
      column = before;
    }
  }

  Assignment best;
  best.column_of_row.assign(rows, -1);
  for (int c = 0; c < columns; ++c) {
    if (row_of_column[c] < 0) continue;
    best.column_of_row[row_of_column[c]] = c;
    best.cost += cost(row_of_column[c], c);
  }
  return best;
}

}  // namespace softforce::allocation
