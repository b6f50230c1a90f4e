#pragma once
/// What nearly every test file includes, read once for all test programs (tests/CMakeLists.txt). Test files
/// still include what they use: the programs that link MRPT are built without it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>
#include <variant>
#include <vector>
