// scatter_blur.h -- how far a path's scatters spread light over the film: where it may enter, and the directions of each
// lobe, are carried through the lens as a paraxial bundle, by the covariance of height y and reduced slope v = n u. What
// lands is as smooth as that.
//
// A gap of length s and index n: y += s v / n. A surface of power P: v -= P y. Source: Gerrard and Burch 1975,
// Introduction to Matrix Methods in Optics, ch. II.
#pragma once

namespace dg {

class ScatterBlur {
  public:
    /// Light that comes in over so wide a part of the front, mm2: in the image of its source it is together again, in a
    /// ghost it is not.
    explicit ScatterBlur(double entry2 = 0) : yy_(entry2) {}
    /// A scatter whose lobe is as wide as `cosines2`, in direction cosines, squared.
    void scatter(double cosines2) { vv_ += cosines2; }
    /// `reduced`: length over index, mm.
    void travel(double reduced) {
        yy_ += reduced * (2 * yv_ + reduced * vv_);
        yv_ += reduced * vv_;
    }
    /// At a surface, 1/mm.
    void bend(double power) {
        vv_ += power * (power * yy_ - 2 * yv_);
        yv_ -= power * yy_;
    }
    /// mm2 across.
    double squared() const { return yy_ > 0 ? yy_ : 0; }

  private:
    double yy_ = 0, yv_ = 0, vv_ = 0;
};

}  // namespace dg
