"""Containers of logs that are not text: Parquet, Arrow, MATLAB 5 and 7.3/HDF5, ROS 1/2, MCAP."""
