// scatter_blur.h -- footprint on the film of a scattering path. The covariance of height y and
// reduced slope v = n u is propagated through the lens as a paraxial bundle; it starts with the
// entry area and grows with each scatter lobe. Light on the film is about as smooth as this
// footprint.
//
// A gap of length s and index n: y += s v / n. A surface of power P: v -= P y. Source: Gerrard and
// Burch 1975, Introduction to Matrix Methods in Optics, ch. II.
#pragma once

namespace dg {

class ScatterBlur {
  public:
    /// Starts with the variance (mm2) of the entry point on the front surface. It vanishes in the
    /// image of the source, but not in a ghost.
    explicit ScatterBlur(double entry2 = 0) : yy_(entry2) {}
    /// Adds a scatter lobe of variance `cosines2` in direction cosines.
    void scatter(double cosines2) { vv_ += cosines2; }
    /// Propagates over a gap; `reduced` is length / index in mm.
    void travel(double reduced) {
        yy_ += reduced * (2 * yv_ + reduced * vv_);
        yv_ += reduced * vv_;
    }
    /// Refracts or reflects at a surface of the given power, 1/mm.
    void bend(double power) {
        vv_ += power * (power * yy_ - 2 * yv_);
        yv_ -= power * yy_;
    }
    /// Variance of the height y, mm2.
    double squared() const { return yy_ > 0 ? yy_ : 0; }

  private:
    double yy_ = 0, yv_ = 0, vv_ = 0;
};

}  // namespace dg
