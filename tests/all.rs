mod kinematics;
mod mass;
mod render;
mod robots;
mod syntax;
