#include <Eigen/Dense>
using M=Eigen::MatrixXd; using C=Eigen::MatrixXcd; using V=Eigen::VectorXd;

