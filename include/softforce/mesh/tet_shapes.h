#pragma once

#include <Eigen/Core>

namespace softforce::mesh {

// Shape functions of a tetrahedron's 4 (order 1) or 10 nodes (order 2) at barycentric coordinates.
Eigen::VectorXd TetShapes(int order, const Eigen::Vector4d& at);

// Their derivatives by the four barycentric coordinates, taken as independent; 4×4 or 10×4.
Eigen::MatrixX4d TetShapeDerivatives(int order, const Eigen::Vector4d& at);

}  // namespace softforce::mesh
