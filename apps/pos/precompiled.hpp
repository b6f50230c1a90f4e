#pragma once
/// What the program's sources include most, read once for all of them (cmake/PosPrecompiled.cmake). Every
/// source still includes what it uses.

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>
