"""Kinematics and inverse kinematics."""
