"""Containers of logs that are not text: Parquet, Arrow, MATLAB, HDF5, NumPy, ROS bags, ULog."""
