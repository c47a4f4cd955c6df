// The kernels of element_kernel.h, for inclusion by one source per instruction set within its
// namespace. Everything here is in an anonymous namespace and calls nothing inline from elsewhere:
// a function that two sources share would be linked once, with the instructions of either.

namespace {

using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));

Lanes Load(const double* from) {
  Lanes value;
  __builtin_memcpy(&value, from, sizeof(value));
  return value;
}

void Store(const Lanes& value, double* to) { __builtin_memcpy(to, &value, sizeof(value)); }

double Sum(const Lanes& value) {
  double sum = 0;
  for (int lane = 0; lane < kLanes; ++lane) sum += value[lane];
  return sum;
}

double Smallest(const Lanes& value) {
  double smallest = value[0];
  for (int lane = 1; lane < kLanes; ++lane)
    smallest = value[lane] < smallest ? value[lane] : smallest;
  return smallest;
}

struct Vector {
  Lanes x, y, z;
};

Vector Cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Lanes Dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vector Scaled(const Lanes& s, const Vector& a) { return {s * a.x, s * a.y, s * a.z}; }
Vector Sum(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

struct Matrix {
  Vector c[3];  // columns
};

Matrix Cofactor(const Matrix& F) {
  return {{Cross(F.c[1], F.c[2]), Cross(F.c[2], F.c[0]), Cross(F.c[0], F.c[1])}};
}
Lanes SquaredNorm(const Matrix& F) {
  return Dot(F.c[0], F.c[0]) + Dot(F.c[1], F.c[1]) + Dot(F.c[2], F.c[2]);
}
Matrix Combined(const Lanes& a, const Matrix& A, const Lanes& b, const Matrix& B) {
  Matrix sum;
  for (int k = 0; k < 3; ++k) sum.c[k] = Sum(Scaled(a, A.c[k]), Scaled(b, B.c[k]));
  return sum;
}

struct Constants {
  Lanes mu, lambda, kappa;
};

// Energy density and first Piola–Kirchhoff stress, as in material.cc.
struct Response {
  BatchEnergy::Status status;
  Lanes energy;
  Matrix P;
};

Response Without(BatchEnergy::Status status) {
  Response response{};
  response.status = status;
  return response;
}

struct NeoHookeanLaw {
  static Response Evaluate(const Constants& m, const Matrix& F) {
    const Matrix C = Cofactor(F);
    const Lanes J = Dot(F.c[0], C.c[0]);
    if (!(Smallest(J) > 0)) return Without(BatchEnergy::Status::kInvalid);
    Lanes log_J, s;
    for (int lane = 0; lane < kLanes; ++lane) {
      log_J[lane] = __builtin_log(J[lane]);
      s[lane] = __builtin_exp(-2.0 / 3 * log_J[lane]);
    }
    const Lanes I1 = SquaredNorm(F);
    const Lanes h = 0.5 * m.kappa * (J - 1 / J) - m.mu * s * I1 / (3 * J);
    return {BatchEnergy::Status::kOk,
            0.5 * m.mu * (s * I1 - 3) + 0.25 * m.kappa * (J * J - 1 - 2 * log_J),
            Combined(m.mu * s, F, h, C)};
  }
};

struct NeoHookeanLogarithmicLaw {
  static Response Evaluate(const Constants& m, const Matrix& F) {
    const Matrix C = Cofactor(F);
    const Lanes J = Dot(F.c[0], C.c[0]);
    if (!(Smallest(J) > 0)) return Without(BatchEnergy::Status::kInvalid);
    Lanes log_J;
    for (int lane = 0; lane < kLanes; ++lane) log_J[lane] = __builtin_log(J[lane]);
    return {BatchEnergy::Status::kOk,
            0.5 * m.mu * (SquaredNorm(F) - 3) - m.mu * log_J + 0.5 * m.lambda * log_J * log_J,
            Combined(m.mu, F, (m.lambda * log_J - m.mu) / J, C)};
  }
};

struct StVenantKirchhoffLaw {
  static Response Evaluate(const Constants& m, const Matrix& F) {
    Lanes E[3][3];  // Green's strain
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) E[i][j] = 0.5 * (Dot(F.c[i], F.c[j]) - (i == j ? 1.0 : 0.0));
    }
    const Lanes trace = E[0][0] + E[1][1] + E[2][2];
    Lanes squared = trace * 0;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) squared += E[i][j] * E[i][j];
    }
    Response response{
        BatchEnergy::Status::kOk, m.mu * squared + 0.5 * m.lambda * trace * trace, {}};
    for (int j = 0; j < 3; ++j) {
      Vector column = Scaled(m.lambda * trace, F.c[j]);
      for (int i = 0; i < 3; ++i) column = Sum(column, Scaled(2 * m.mu * E[i][j], F.c[i]));
      response.P.c[j] = column;
    }
    return response;
  }
};

struct CorotationalLaw {
  static Response Evaluate(const Constants& m, const Matrix& F) {
    // The rotation by Newton's iteration for the polar decomposition, scaled (Higham 1986): R ←
    // (s R + (s R)⁻ᵀ) / 2.
    Matrix R = F;
    bool settled = false;
    for (int iteration = 0; iteration < 12 && !settled; ++iteration) {
      const Matrix C = Cofactor(R);
      const Lanes J = Dot(R.c[0], C.c[0]);
      if (!(Smallest(J) > 1e-3)) return Without(BatchEnergy::Status::kHard);
      const Lanes inverse = 1 / J;
      const Lanes ratio = inverse * inverse * SquaredNorm(C) / SquaredNorm(R);
      Lanes s;
      for (int lane = 0; lane < kLanes; ++lane) {
        s[lane] = __builtin_sqrt(__builtin_sqrt(ratio[lane]));
      }
      const Matrix next = Combined(0.5 * s, R, 0.5 * inverse / s, C);
      const Matrix change = Combined(s * 0 + 1, next, s * 0 - 1, R);
      settled = Smallest(-SquaredNorm(change)) > -1e-28;  // of |R|² = 3
      R = next;
    }
    if (!settled) return Without(BatchEnergy::Status::kHard);
    const Matrix D = Combined(m.mu * 0 + 1, F, m.mu * 0 - 1, R);
    const Lanes stretch = Dot(R.c[0], F.c[0]) + Dot(R.c[1], F.c[1]) + Dot(R.c[2], F.c[2]) - 3;
    return {BatchEnergy::Status::kOk, m.mu * SquaredNorm(D) + 0.5 * m.lambda * stretch * stretch,
            Combined(2 * m.mu, D, m.lambda * stretch, R)};
  }
};

template <typename Law, int kNodes, int kPoints>
BatchEnergy EnergyAndForces(const ElementBatch& batch) {
  const Constants constants{Load(batch.mu), Load(batch.lambda), Load(batch.kappa)};
  Lanes energy = {};
  Vector forces[kNodes] = {};
  for (int p = 0; p < kPoints; ++p) {
    const double* gradients = batch.gradients + p * kNodes * 3 * kLanes;
    Matrix F = {};
    for (int k = 0; k < 3; ++k) (k == 0 ? F.c[0].x : k == 1 ? F.c[1].y : F.c[2].z) += 1;
    for (int i = 0; i < kNodes; ++i) {
      const Vector u{Load(batch.u + (3 * i) * kLanes), Load(batch.u + (3 * i + 1) * kLanes),
                     Load(batch.u + (3 * i + 2) * kLanes)};
      for (int k = 0; k < 3; ++k) {
        F.c[k] = Sum(F.c[k], Scaled(Load(gradients + (3 * i + k) * kLanes), u));
      }
    }
    const Response response = Law::Evaluate(constants, F);
    if (response.status != BatchEnergy::Status::kOk) return {response.status, 0};
    const Lanes weight = Load(batch.weights + p * kLanes);
    energy += weight * response.energy;
    const Vector P[3] = {Scaled(weight, response.P.c[0]), Scaled(weight, response.P.c[1]),
                         Scaled(weight, response.P.c[2])};
    for (int i = 0; i < kNodes; ++i) {
      for (int k = 0; k < 3; ++k) {
        forces[i] = Sum(forces[i], Scaled(Load(gradients + (3 * i + k) * kLanes), P[k]));
      }
    }
  }
  for (int i = 0; i < kNodes; ++i) {
    Store(forces[i].x, batch.forces + (3 * i) * kLanes);
    Store(forces[i].y, batch.forces + (3 * i + 1) * kLanes);
    Store(forces[i].z, batch.forces + (3 * i + 2) * kLanes);
  }
  return {BatchEnergy::Status::kOk, Sum(energy)};
}

template <typename Law>
ElementKernel KernelOfLaw(int nodes) {
  return nodes == 10 ? &EnergyAndForces<Law, 10, 4> : &EnergyAndForces<Law, 4, 1>;
}

}  // namespace

ElementKernel KernelFor(MaterialModel model, int nodes) {
  switch (model) {
    case MaterialModel::kCorotational:
      return KernelOfLaw<CorotationalLaw>(nodes);
    case MaterialModel::kStVenantKirchhoff:
      return KernelOfLaw<StVenantKirchhoffLaw>(nodes);
    case MaterialModel::kNeoHookean:
      return KernelOfLaw<NeoHookeanLaw>(nodes);
    case MaterialModel::kNeoHookeanLogarithmic:
      return KernelOfLaw<NeoHookeanLogarithmicLaw>(nodes);
  }
  return nullptr;
}
