#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "estimation/identification_fit.h"
#include "softforce/estimation/identification.h"

namespace softforce::estimation {

// One identification under way.
class IdentificationTask {
 public:
  IdentificationTask(const fem::Body& body, const std::vector<KnownState>& states,
                     const std::vector<Unknown>& unknowns, const geometry::Matrix6d& registration,
                     const IdentificationOptions& options);

  Identification Run();

 private:
  void RefuseUnusable();
  bool EnoughObservations();
  std::vector<double> Displacements() const;
  bool FitToSettledScale();
  bool Fit();
  bool Stopped();
  std::string WhyNotSettled() const;
  bool RejectAndFit();
  Eigen::MatrixXd InformationOnUnknowns(bool with_loss) const;
  bool Observable();
  bool InRange();
  std::string Why(const Eigen::VectorXd& combination) const;
  void Conclude();
  StateFit DescribeState(int state) const;
  void Fail(Identification::Status status, const std::string& reason);

  const std::vector<KnownState>& states_;
  const std::vector<Unknown>& unknowns_;
  const IdentificationOptions& options_;
  const fem::Body& rest_;
  ParametricBody body_;
  OffsetModel offset_;
  Eigen::VectorXd guess_, prior_sd_;
  Identification result_;
  std::vector<double> displacements_;
  std::optional<IdentificationFit> fit_;
  Eigen::VectorXd parameters_;
};

}  // namespace softforce::estimation
