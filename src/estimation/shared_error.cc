#include "estimation/shared_error.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace softforce::estimation {

double ErrorCorrelation(double s, double t) {
  const double larger = std::max(s, t);
  return larger > 0 ? std::min(s, t) / larger : 1;
}

Eigen::MatrixXd SharedErrorWhitening(const std::vector<const Observation*>& sharing,
                                     const std::vector<double>& sd) {
  Eigen::Index rows = 0;
  for (const Observation* seen : sharing) rows += seen->whitening.rows();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(rows, rows);
  Eigen::Index row = 0;
  for (size_t i = 0; i < sharing.size(); ++i) {
    const Whitening& of_row = sharing[i]->whitening;
    Eigen::Index column = 0;
    for (size_t j = 0; j < sharing.size(); ++j) {
      const Whitening& of_column = sharing[j]->whitening;
      covariance.block(row, column, of_row.rows(), of_column.rows()) +=
          ErrorCorrelation(sd[i], sd[j]) * sd[i] * sd[j] * of_row * of_column.transpose();
      column += of_column.rows();
    }
    row += of_row.rows();
  }
  return covariance.llt().matrixL().solve(Eigen::MatrixXd::Identity(rows, rows));
}

}  // namespace softforce::estimation
