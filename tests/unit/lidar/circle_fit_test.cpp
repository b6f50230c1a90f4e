#include "pos/lidar/circle_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "leg_scene.hpp"

namespace pos::lidar {
namespace {

using scene::arc;

constexpr double kStep = 0.25 * kPi / 180.0;

sim::LegCylinder leg(double x, double y, double radius, double tilt) {
  return {.point = {x, y, 0.0}, .axis = {0.0, -std::sin(tilt), std::cos(tilt)}, .radius = radius};
}

/// Points of the circle about `centre` that the origin sees, `span` rad of arc from `from` rad off the
/// middle.
std::vector<Eigen::Vector2d> partOfCircle(const Eigen::Vector2d& centre, double radius, double from,
                                          double span, int count) {
  const double towards = std::atan2(-centre.y(), -centre.x());
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < count; ++i) {
    const double angle = towards + from + span * i / (count - 1);
    points.emplace_back(centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return points;
}

}  // namespace

TEST(CircleFit, JacobianMatchesDifferences) {
  RandomStream random(4, 1);
  for (int i = 0; i < 100; ++i) {
    const double px = random.uniform(-3.0, 3.0);
    const double py = random.uniform(3.0, 9.0);
    const Eigen::Vector2d p(px, py);
    const double dx = random.uniform(-0.3, 0.3);
    const Eigen::Vector2d centre = p + Eigen::Vector2d(dx, 0.2);
    const CircleResidual at = circleResidual(p, centre, 0.15);
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector2d h = 1e-5 * Eigen::Vector2d::Unit(k);
      const double slope =
          (circleResidual(p, centre + h, 0.15).e - circleResidual(p, centre - h, 0.15).e) / 2e-5;
      EXPECT_NEAR(at.J[k], slope, 1e-6);
    }
  }
}

// Spec B, C3 property 13.
TEST(CircleFit, IsExactForThreePointsOnAnArcOfTwentyDegrees) {
  RandomStream random(4, 2);
  for (const ArcWeights weights : {ArcWeights::Even, ArcWeights::Noise, ArcWeights::Huber}) {
    for (int i = 0; i < 200; ++i) {
      const double bearing = random.uniform(0.1, 3.0);
      const double range = random.uniform(4.0, 12.0);
      const Eigen::Vector2d centre = range * Eigen::Vector2d(std::cos(bearing), std::sin(bearing));
      const double span = radians(random.uniform(20.0, 110.0));
      const double from = random.uniform(radians(-65.0), radians(65.0) - span);
      const double radius = random.uniform(0.05, 0.25);
      const auto fit =
          fittedCircle(partOfCircle(centre, radius, from, span, 3), {.radius = radius, .weights = weights});
      ASSERT_TRUE(fit) << i;
      EXPECT_LT((fit->centre - centre).norm(), 1e-6);
      EXPECT_LT(fit->rms, 1e-6);
    }
  }
}

TEST(CircleFit, TurnsWithThePoints) {
  RandomStream random(4, 3);
  const std::vector<Eigen::Vector2d> points = arc(leg(3.0, 4.0, 0.15, 0.0), 0.0, kStep, 0.01, random);
  const auto fit = fittedCircle(points, {});
  ASSERT_TRUE(fit);
  const Eigen::Matrix2d R = rotation2(0.7);
  std::vector<Eigen::Vector2d> turned;
  for (const Eigen::Vector2d& p : points) turned.push_back(R * p);
  const auto again = fittedCircle(turned, {});
  ASSERT_TRUE(again);
  EXPECT_LT((again->centre - R * fit->centre).norm(), 1e-9);
  EXPECT_LT((again->covariance - R * fit->covariance * R.transpose()).norm(), 1e-9 * fit->covariance.norm());
}

// Even weights know nothing of where the scanner is, so that only the start moves with it.
TEST(CircleFit, ShiftsWithThePoints) {
  RandomStream random(4, 4);
  const std::vector<Eigen::Vector2d> points = arc(leg(3.0, 4.0, 0.15, 0.0), 0.0, kStep, 0.01, random);
  const CircleFitConfig even{.weights = ArcWeights::Even, .step_small = 1e-12};
  const auto fit = fittedCircle(points, even);
  ASSERT_TRUE(fit);
  std::vector<Eigen::Vector2d> moved;
  for (const Eigen::Vector2d& p : points) moved.emplace_back(p + Eigen::Vector2d(1.0, 2.0));
  const auto again = fittedCircle(moved, even);
  ASSERT_TRUE(again);
  EXPECT_LT((again->centre - fit->centre - Eigen::Vector2d(1.0, 2.0)).norm(), 1e-9);
}

// Spec B, B5: 1.4, 2.1 and 2.8 mm for radii of 0.10, 0.15 and 0.20 m; the spec's own bar is 3 mm.
TEST(CircleFit, TiltOfTenDegreesBiasesByLessThanThreeMillimetres) {
  RandomStream random(4, 5);
  const std::vector<std::pair<double, double>> facts{{0.10, 1.4e-3}, {0.15, 2.1e-3}, {0.20, 2.8e-3}};
  for (const auto& [radius, bias] : facts) {
    double worst = 0.0;
    for (double along = -12.0; along <= 12.0; along += 0.11) {
      const double first = random.uniform(0.0, kStep);
      const auto points = arc(leg(along, 4.0, radius, radians(10.0)), first, kStep, 0.0, random);
      const auto fit = fittedCircle(points, {.radius = radius});
      ASSERT_TRUE(fit);
      worst = std::max(worst, (fit->centre - Eigen::Vector2d(along, 4.0)).norm());
    }
    EXPECT_NEAR(worst, bias, 1e-4) << radius;
  }
}

// Spec B, C3 property 13: within 20 %. 1000 trials tell a standard deviation to 2.2 %.
TEST(CircleFit, CovarianceIsThatOfTheScatter) {
  RandomStream random(4, 6);
  for (const ArcWeights weights : {ArcWeights::Even, ArcWeights::Noise, ArcWeights::Huber}) {
    for (const double along : {0.4, 4.5, 9.0}) {
      const Eigen::Vector2d centre(along, 4.0);
      Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
      Eigen::Matrix2d told = Eigen::Matrix2d::Zero();
      for (int i = 0; i < 1000; ++i) {
        const double first = random.uniform(0.0, kStep);
        const auto fit = fittedCircle(arc(leg(along, 4.0, 0.15, 0.0), first, kStep, 0.01, random),
                                      {.sigma_angle = 0.0, .weights = weights});
        ASSERT_TRUE(fit);
        scatter += (fit->centre - centre) * (fit->centre - centre).transpose() / 1000.0;
        told += fit->covariance / 1000.0;
      }
      for (const Eigen::Vector2d& axis :
           {Eigen::Vector2d(centre.normalized()),
            Eigen::Vector2d(-centre.normalized().y(), centre.normalized().x())}) {
        const double ratio = std::sqrt(axis.dot(told * axis) / axis.dot(scatter * axis));
        EXPECT_GT(ratio, 0.9) << along;
        EXPECT_LT(ratio, 1.1) << along;
      }
    }
  }
}

TEST(CircleFit, HuberBearsASpeckBeforeTheLeg) {
  RandomStream random(4, 7);
  double even = 0.0;
  double huber = 0.0;
  for (int i = 0; i < 200; ++i) {
    std::vector<Eigen::Vector2d> points =
        arc(leg(5.0, 4.0, 0.15, 0.0), random.uniform(0.0, kStep), kStep, 0.01, random);
    points[points.size() / 2] *= 1.0 - 0.06 / points[points.size() / 2].norm();  // dust 6 cm before it
    const Eigen::Vector2d centre(5.0, 4.0);
    const auto plain = fittedCircle(points, {.weights = ArcWeights::Even});
    const auto robust = fittedCircle(points, {.weights = ArcWeights::Huber});
    ASSERT_TRUE(plain && robust);
    even += (plain->centre - centre).squaredNorm() / 200.0;
    huber += (robust->centre - centre).squaredNorm() / 200.0;
  }
  EXPECT_LT(huber, 0.5 * even);
}

TEST(CircleFit, RefusesWhatHoldsNoCircle) {
  EXPECT_FALSE(fittedCircle({}, {}));
  const std::vector<Eigen::Vector2d> same(5, Eigen::Vector2d(3.0, 4.0));
  EXPECT_FALSE(fittedCircle(same, {}));  // one direction only
  const std::vector<Eigen::Vector2d> none(5, Eigen::Vector2d::Constant(std::nan("")));
  EXPECT_FALSE(fittedCircle(none, {}));
}

// Another way to the same centre: the cut of a tilted leg seen from all round is an ellipse that OpenCV fits
// freely. The far side is drawn here, no scanner sees it.
TEST(CircleFit, CentreAgreesWithAnEllipseFit) {
  const sim::LegCylinder tilted = leg(5.0, 4.0, 0.15, radians(10.0));
  const sim::LegEllipse cut = sim::cutByScanPlane(tilted);
  std::vector<cv::Point2f> around;
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 72; ++i) {
    const double angle = 2.0 * kPi * i / 72.0;
    points.emplace_back(cut.centre.x() + cut.semi_minor * std::cos(angle),
                        cut.centre.y() + cut.semi_major * std::sin(angle));
    around.emplace_back(static_cast<float>(points.back().x() - 5.0),
                        static_cast<float>(points.back().y() - 4.0));
  }
  const cv::RotatedRect ellipse = cv::fitEllipse(around);
  EXPECT_NEAR(std::max(ellipse.size.width, ellipse.size.height) / 2.0, 0.15 * 1.0154, 1e-4);
  const auto fit = fittedCircle(points, {.weights = ArcWeights::Even});
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->centre.x(), 5.0 + static_cast<double>(ellipse.center.x), 1e-5);
  EXPECT_NEAR(fit->centre.y(), 4.0 + static_cast<double>(ellipse.center.y), 1e-5);
}

}  // namespace pos::lidar
