#pragma once
/// A scan made ready for the likelihood field: chosen beams as end points on the body, each with the share of
/// independent information it carries.

#include "pos/core/measurement.hpp"
#include "pos/estimation/configs.hpp"
#include "pos/lidar/likelihood_field.hpp"

namespace pos::estimation {

/// At most `config.beams` valid beams, spread evenly over the valid ones. Beam b gets the weight
/// tempering / (number of chosen beams that end in its square of side correlation_length): what is wrong with
/// the map there is wrong for all of them, so that together they count as one beam. Empty when no beam is
/// valid.
lidar::BeamPoints beamPoints(const Scan2D& scan, const ScanLikelihood& config);

}  // namespace pos::estimation
