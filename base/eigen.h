#pragma once

#include <Eigen/Core>

// Eigen, as the library and its users must both see it. Matrices are handed across by value and
// made on one side and freed on the other, so both sides must mean the same bytes by them, whatever
// instruction set each is compiled for. Installed headers get Eigen from here.

#define VMECH_AGREEMENT                                                                   \
  " must be what vmech was compiled with: link to a target vmech::<module> of the CMake " \
  "package, or compile every file with -std=c++20 -DEIGEN_MAX_ALIGN_BYTES=64 "            \
  "-DEIGEN_MAX_STATIC_ALIGN_BYTES=16 and without EIGEN_DONT_ALIGN, "                      \
  "EIGEN_DEFAULT_TO_ROW_MAJOR and EIGEN_DEFAULT_DENSE_INDEX_TYPE"

static_assert(EIGEN_MAX_ALIGN_BYTES == 64, "Eigen's alignment of the heap" VMECH_AGREEMENT);
static_assert(EIGEN_MAX_STATIC_ALIGN_BYTES == 16 && alignof(Eigen::Vector2d) == 16 &&
                  alignof(Eigen::Vector4d) == 16 && alignof(Eigen::Vector3d) == alignof(double),
              "Eigen's alignment of members" VMECH_AGREEMENT);
static_assert(sizeof(Eigen::Index) == 8, "Eigen's index" VMECH_AGREEMENT);
static_assert(!Eigen::MatrixXd::IsRowMajor, "Eigen's order of storage" VMECH_AGREEMENT);

#undef VMECH_AGREEMENT
